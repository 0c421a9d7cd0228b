#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/payload_parts.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int link, const Eigen::VectorXd&) {
  return reference::link_regressor(at.robot, at.motions, link);
}

}  // namespace

Effect payload() {
  Effect e;
  e.id = "payload";
  e.title = "a body is attached to the link";
  e.equation = "tau += (ten columns of Y of the link) (parameters of the load)";
  e.site = SiteKind::link;
  e.parameters = load_parameters();
  e.confused_with = {"the link's own inertia", "payload on a neighbour", "torque_gain"};
  e.separate_by =
      "a log of the same robot without it (--reference), both with the joints between the links "
      "where it might be moved; or a trusted model";
  e.under_contact = "as the link's own parameters";
  e.source = "docs/derivations/regressor.md";
  e.applies = moves;
  e.columns = columns;
  e.is_payload = true;
  e.code.link =
      "at.carry(j, m, {mrx, mry, mrz}, {{Ixx, Ixy, Ixz}, {Ixy, Iyy, Iyz}, {Ixz, Iyz, Izz}});";
  return e;
}

}  // namespace shapeid::diagnosis
