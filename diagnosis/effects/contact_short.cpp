#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"

namespace shapeid::diagnosis {
namespace {

Sample touching(const Moment& moment, int contact, const Eigen::VectorXd& value) {
  return with_contact(moment.now, contact, moment.surroundings.since_touch, value[0]);
}

}  // namespace

Effect contact_short() {
  Effect e;
  e.id = "contact_short";
  e.title = "the foot still touches when it is declared lifted";
  e.equation = "the contact counts as touching until T s after it was last declared to, in J";
  e.site = SiteKind::contact;
  e.parameters = {contact_time()};
  e.confused_with = {"external_force on the same leg", "contact_point"};
  e.separate_by = "log foot switches, or declare contacts longer";
  e.under_contact = "seen: nothing projects the force away";
  e.source = "docs/derivations/diagnosis-rows.md";
  e.sought_first = true;
  e.transform.sample = touching;
  return e;
}

}  // namespace shapeid::diagnosis
