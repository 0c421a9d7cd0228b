// A force at a contact while its flag says one thing or the other.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/effect.hpp"
#include "shapeid/models/contact_margin.hpp"
#include "shapeid/reference/contact.hpp"

namespace shapeid::diagnosis {

/// A force at a contact, base axes.
inline std::vector<Parameter> contact_force_parameters() {
  return {{"x", "N", false, 5.0}, {"y", "N", false, 5.0}, {"z", "N", false, 5.0}};
}

/// By how much a flag is wrong.
inline Parameter contact_time() { return {"T", "s", true, 0.02, 0.2}; }

/// The sample with the contact touching if that is no more than T s away (`times`: of each
/// contact).
inline Sample with_contact(Sample sample, int contact, const Eigen::VectorXd& times, double T) {
  if (contact < times.size() && times[contact] <= T + time_rounding) {
    sample.in_contact[static_cast<std::size_t>(contact)] = true;
  }
  return sample;
}

/// -J_contact^T in samples whose flag is `declared`, zero in the others: dof x 3.
inline Eigen::MatrixXd force_columns(const Instant& at, int contact, bool declared) {
  const auto c = static_cast<std::size_t>(contact);
  const bool flag = c < at.sample.in_contact.size() && at.sample.in_contact[c];
  if (flag != declared) return Eigen::MatrixXd::Zero(at.robot.dof(), 3);
  const Contact& place = at.robot.contacts[c];
  const Eigen::Vector3d point =
      at.motions[static_cast<std::size_t>(place.link)].pose * place.frame.translation();
  return -reference::point_jacobian(at.robot, at.motions, place.link, point)
              .topRows<3>()
              .transpose();
}

/// Where the rows of a contact begin in J; empty if it does not touch, or where contacts are not
/// projected away: J has no rows then, whatever the flags say.
inline std::optional<Eigen::Index> stance_row(const Robot& robot, const Sample& sample, int contact,
                                              const Rows& rows) {
  const auto wanted = static_cast<std::size_t>(contact);
  if (rows.J.rows() == 0 || wanted >= sample.in_contact.size() || !sample.in_contact[wanted]) {
    return std::nullopt;
  }
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < wanted; ++c) {
    if (sample.in_contact[c]) row += force_numbers(robot.contacts[c].kind);
  }
  return row;
}

/// Moves the point of a touching contact by `arm` (base axes): v_point += omega x arm.
inline void move_point(const Robot& robot, const std::vector<reference::LinkMotion>& motions,
                       int contact, const Eigen::Vector3d& arm, Eigen::Index row, Rows& rows) {
  const int link = robot.contacts[static_cast<std::size_t>(contact)].link;
  const auto turning = reference::point_jacobian(robot, motions, link, Eigen::Vector3d::Zero());
  rows.J.middleRows<3>(row) -= reference::skew(arm) * turning.bottomRows<3>();
}

}  // namespace shapeid::diagnosis
