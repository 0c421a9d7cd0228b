#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/payload_parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int link, const Eigen::VectorXd&) {
  const Eigen::Vector3d origin = at.motions[static_cast<std::size_t>(link)].pose.translation();
  return -reference::point_jacobian(at.robot, at.motions, link, origin).topRows<3>().transpose();
}

}  // namespace

Effect external_force() {
  Effect e;
  e.id = "external_force";
  e.title = "a constant force pulls at the link's origin";
  e.equation = "tau -= J_link^T (x, y, z), force in base axes";
  e.site = SiteKind::link;
  e.parameters = {{"x", "N", false, 5.0}, {"y", "N", false, 5.0}, {"z", "N", false, 5.0}};
  e.confused_with = {"payload", "accel_bias", "accel_noise", "torque_offset", "contact_undeclared"};
  e.separate_by = "turn the robot: a cable keeps its direction, a load its weight";
  e.under_contact = "on the base hidden as far as feet can balance it";
  e.source = "virtual power, docs/derivations/regressor.md";
  e.applies = moves;
  e.columns = columns;
  e.code.link = "at.f[j] += Vector{-x, -y, -z};";
  return e;
}

}  // namespace shapeid::diagnosis
