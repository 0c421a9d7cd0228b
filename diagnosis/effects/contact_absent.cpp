#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int contact, const Eigen::VectorXd&) {
  return force_columns(at, contact, true);
}

}  // namespace

Effect contact_absent() {
  Effect e;
  e.id = "contact_absent";
  e.title = "the foot is declared on the ground and does not touch";
  e.equation =
      "tau -= J_contact^T (x, y, z) while declared on the ground: the force that is missing";
  e.site = SiteKind::contact;
  e.parameters = contact_force_parameters();
  e.confused_with = {"a slipping foot"};
  e.separate_by = "log foot switches; the feet's velocities tell, torques cannot";
  e.under_contact =
      "hidden entirely: it only costs rows. Told by feet that move against each other";
  e.source = "docs/derivations/projection.md";
  e.columns = columns;
  return e;
}

}  // namespace shapeid::diagnosis
