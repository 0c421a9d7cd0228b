#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/parts.hpp"

namespace shapeid::diagnosis {
namespace {

// Of the predicted load: the logged torque is what is to be predicted.
Eigen::MatrixXd columns(const Instant& at, int joint, const Eigen::VectorXd&) {
  return joint_column(at, joint, -at.load_rate[joint]);
}

}  // namespace

Effect torque_lag() {
  Effect e;
  e.id = "torque_lag";
  e.title = "one drive's torque goes through a slow filter of its own";
  e.equation = "tau_j -= T d(load_j)/dt, the rate of T ago";
  e.site = SiteKind::joint;
  e.parameters = {{"T", "s", true, 0.002, 0.05}};
  e.confused_with = {"viscous_friction (under gravity or with an inertia alone)", "torque_delay"};
  e.separate_by = "knock on the link: compare when this drive and its neighbours feel it";
  e.under_contact =
      "seen in swing; the load in stance is predicted from the base's balance, and what feet push "
      "against each other from the torque";
  e.source = "docs/derivations/filtering.md";
  e.columns = columns;
  e.filters_load = true;
  e.code.torque = "tau[j] -= T * load_rate[j];";
  return e;
}

}  // namespace shapeid::diagnosis
