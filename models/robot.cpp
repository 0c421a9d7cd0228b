#include "shapeid/models/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace shapeid {

std::string unit_at(const Joint& joint, std::string rotary) {
  if (joint.kind != JointKind::prismatic) return rotary;
  using Pair = std::pair<std::string_view, std::string_view>;
  for (const auto& [turns, slides] : {Pair{"N m", "N"}, Pair{"kg m^2", "kg"}, Pair{"rad", "m"}}) {
    const std::size_t at = rotary.find(turns);
    if (at != std::string::npos) rotary.replace(at, turns.size(), slides);
  }
  return rotary;
}

double Robot::mass() const {
  double sum = 0.0;
  for (const Link& link : links) sum += link.inertia.mass();
  return sum;
}

std::optional<LinkSite> Robot::find_site(const std::string& wanted) const {
  for (int i = 0; i < link_count(); ++i) {
    const Link& link = links[static_cast<std::size_t>(i)];
    for (const Member& member : link.members) {
      if (member.name == wanted) return LinkSite{i, member.pose};
    }
    if (link.name == wanted) return LinkSite{i, Eigen::Isometry3d::Identity()};
  }
  return std::nullopt;
}

std::optional<int> Robot::find_link(const std::string& wanted) const {
  const std::optional<LinkSite> site = find_site(wanted);
  return site ? std::optional<int>(site->link) : std::nullopt;
}

std::optional<int> Robot::find_joint(const std::string& wanted) const {
  for (int j = 0; j < joint_count(); ++j) {
    if (joint(j).name == wanted) return j;
  }
  return std::nullopt;
}

Violation why_malformed(const Robot& robot) {
  if (robot.links.empty()) return "a robot has no links";
  if (robot.links.front().parent != -1) return "link 0 is not the root";
  constexpr double unit_slack = 1e-9;  // a direction read from a file and normalised once
  for (int i = 0; i < robot.link_count(); ++i) {
    const Link& link = robot.links[static_cast<std::size_t>(i)];
    if (!link.inertia.values.allFinite()) return fmt::format("inertia of {} not finite", link.name);
    if (i == 0) continue;
    if (link.parent < 0 || link.parent >= i) {
      return fmt::format("parent of link {} does not stand before it", link.name);
    }
    if (std::abs(link.joint.axis.norm() - 1.0) > unit_slack) {
      return fmt::format("axis of joint {} is not a unit vector", link.joint.name);
    }
  }
  for (const Contact& contact : robot.contacts) {
    if (contact.link < 0 || contact.link >= robot.link_count()) {
      return fmt::format("contact {} is on no link", contact.name);
    }
  }
  return std::nullopt;
}

Eigen::VectorXd stacked_parameters(const Robot& robot) {
  Eigen::VectorXd Phi(10 * robot.link_count());
  for (int i = 0; i < robot.link_count(); ++i) {
    Phi.segment<10>(Eigen::Index{10} * i) = robot.links[static_cast<std::size_t>(i)].inertia.values;
  }
  return Phi;
}

Violation why_not_stacked(const Eigen::VectorXd& Phi, const Robot& robot) {
  if (Phi.size() == Eigen::Index{10} * robot.link_count()) return std::nullopt;
  return "not ten parameters for each link";
}

}  // namespace shapeid
