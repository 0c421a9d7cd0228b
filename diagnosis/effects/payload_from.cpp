#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/payload_parts.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int link, const Eigen::VectorXd& shape) {
  const double carried = at.surroundings.elapsed >= shape[0] ? 1.0 : 0.0;
  return carried * reference::link_regressor(at.robot, at.motions, link);
}

}  // namespace

Effect payload_from() {
  Effect e;
  e.id = "payload_from";
  e.title = "a body is attached to the link from some moment on";
  e.equation = "tau += (ten columns of Y of the link) (parameters of the load), for t >= onset";
  e.site = SiteKind::link;
  e.parameters = load_parameters();
  e.shape = {{"onset", "s", 0.1, 1e5, 1.0, 0.0, true}};
  e.confused_with = {"payload_from on a neighbour", "torque_gain that changes", "external_force"};
  e.separate_by = "move the joints between the two links while carrying";
  e.under_contact = "as the link's own parameters";
  e.source = "docs/derivations/regressor.md";
  e.applies = moves;
  e.columns = columns;
  e.is_payload = true;
  return e;
}

}  // namespace shapeid::diagnosis
