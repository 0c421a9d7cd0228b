#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

// A contact that touches now or did then counts as touching: that costs rows, and is never wrong.
// (Flags near a touch are on already, for the filter smears its force. With those of then alone the
// first rows before a touch would have more of that force in them than without the delay.)
Sample earlier(const Moment& moment, int, const Eigen::VectorXd& value) {
  Sample sample = moment.at(-value[0]);
  sample.tau = moment.now.tau;
  sample.time = moment.now.time;
  for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
    sample.in_contact[c] = sample.in_contact[c] || moment.now.in_contact[c];
  }
  return sample;
}

}  // namespace

Effect torque_delay() {
  Effect e;
  e.id = "torque_delay";
  e.title = "the logged torque belongs to an earlier motion";
  e.equation = "tau(t) is predicted from the motion at t - d";
  e.site = SiteKind::whole;
  e.parameters = {{"d", "s", false, 0.002, largest_delay}};
  e.confused_with = {
      "viscous_friction (d > 0 looks like it on an inertia, d < 0 like a negative one)",
      "imu_delay", "unequal filtering of torque and joints"};
  e.separate_by = "tap the robot: the same knock must come at the same time in all channels";
  e.under_contact = "seen in stance and swing";
  e.source = "docs/derivations/filtering.md";
  e.transform.sample = earlier;
  return e;
}

}  // namespace shapeid::diagnosis
