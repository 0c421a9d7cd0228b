#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::MatrixXd columns(const Instant& at, int contact, const Eigen::VectorXd&) {
  return force_columns(at, contact, false);
}

}  // namespace

Effect contact_undeclared() {
  Effect e;
  e.id = "contact_undeclared";
  e.title = "the foot carries force while it is declared in the air";
  e.equation = "tau -= J_contact^T (x, y, z) while declared in the air, mean force in base axes";
  e.site = SiteKind::contact;
  e.parameters = contact_force_parameters();
  e.confused_with = {"external_force on the same leg", "contact_late", "contact_short"};
  e.separate_by = "lift the robot off the ground, or log foot switches";
  e.under_contact = "seen: nothing projects the force away";
  e.source = "virtual power, docs/derivations/regressor.md";
  e.columns = columns;
  return e;
}

}  // namespace shapeid::diagnosis
