#include "shapeid/models/sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shapeid {

Violation why_malformed(const Sample& s, const Robot& robot) {
  const Eigen::Index n = robot.joint_count();
  if (s.q.size() != n || s.dq.size() != n || s.ddq.size() != n || s.tau.size() != n) {
    return fmt::format("q, dq, ddq, tau have {}, {}, {}, {} entries for {} joints", s.q.size(),
                       s.dq.size(), s.ddq.size(), s.tau.size(), n);
  }
  if (!s.in_contact.empty() && s.in_contact.size() != robot.contacts.size()) {
    return fmt::format("{} contact flags for {} contacts", s.in_contact.size(),
                       robot.contacts.size());
  }
  if (!s.contact_force.empty() && s.contact_force.size() != robot.contacts.size()) {
    return fmt::format("{} contact forces for {} contacts", s.contact_force.size(),
                       robot.contacts.size());
  }
  const bool finite =
      std::isfinite(s.time) && s.q.allFinite() && s.dq.allFinite() && s.ddq.allFinite() &&
      s.tau.allFinite() && s.base_angular_velocity.allFinite() &&
      s.base_angular_acceleration.allFinite() && s.base_specific_force.allFinite() &&
      std::all_of(s.contact_force.begin(), s.contact_force.end(),
                  [](const Eigen::Vector3d& f) { return f.allFinite(); });
  if (!finite) return "a number of the sample is not finite";
  return std::nullopt;
}

}  // namespace shapeid
