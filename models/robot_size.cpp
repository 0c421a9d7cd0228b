#include "shapeid/models/robot_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shapeid {
namespace {

/// A load on a long boom is a few times as far away as the robot is large, and millimetres that
/// are taken for metres are a thousand times.
constexpr double furthest = 30.0;

double travel(const Joint& joint) {
  if (joint.kind != JointKind::prismatic) return 0.0;
  const double most = std::max(std::abs(joint.lower), std::abs(joint.upper));
  return std::isfinite(most) ? most : 0.0;
}

/// m: a link of one piece is as large as its inertia says, wherever its origin is.
double gyration(const Link& link) {
  const double mass = link.inertia.mass();
  if (!(mass > 0.0)) return 0.0;
  const double squared = 0.5 * link.inertia.tensor_about_centre().trace() / mass;
  return squared > 0.0 && std::isfinite(squared) ? std::sqrt(squared) : 0.0;
}

}  // namespace

double size_of(const Robot& robot) {
  std::vector<double> origin(robot.links.size(), 0.0);
  double size = 0.0;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Link& link = robot.links[i];
    if (link.parent >= 0) {
      origin[i] = origin[static_cast<std::size_t>(link.parent)] +
                  link.joint.placement.translation().norm() + travel(link.joint);
    }
    size = std::max(size, origin[i] + link.inertia.centre_of_mass().norm() + gyration(link));
    for (const Member& member : link.members) {
      size = std::max(size, origin[i] + member.pose.translation().norm());
    }
  }
  return size;
}

std::optional<std::string> why_too_far(double distance, const Robot& robot) {
  const double size = size_of(robot);
  if (!(size > 0.0) || !(distance > furthest * size)) return {};
  return fmt::format("{:.3g} m from the link's origin, on a robot of {:.2g} m", distance, size);
}

}  // namespace shapeid
