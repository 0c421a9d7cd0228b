// Contacts that count as touching for as long as a delay of the torque carries their force.
#include "shapeid/diagnosis/contact_reach.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::diagnosis {
namespace {

using test::Trot;

Found delay_of_torque(double d) {
  AppliedEffect delay = at_start(*find_effect("torque_delay"), 0);
  delay.value[0] = d;
  return {delay, "", Eigen::VectorXd::Zero(1)};
}

TEST(ContactReach, IsThatOfTheLongestDelayEitherWay) {
  const ContactReach none = contact_reach({}, 500.0, {});
  EXPECT_EQ(none.before, 0.0);
  EXPECT_EQ(none.after, 0.0);
  const ContactReach reach =
      contact_reach({delay_of_torque(-0.0042), delay_of_torque(0.0021)}, 500.0, {0.004, 0.001});
  EXPECT_DOUBLE_EQ(reach.before, 0.006) << "three samples";
  EXPECT_DOUBLE_EQ(reach.after, 0.004);
  EXPECT_EQ(contact_reach({delay_of_torque(0.0009)}, 500.0, {}).after, 0.0);
  EXPECT_TRUE(reach.covers(none));
  EXPECT_FALSE(none.covers(reach));
  const ContactReach kept = contact_reach({delay_of_torque(0.001)}, 500.0, reach);
  EXPECT_DOUBLE_EQ(kept.before, 0.006);
  EXPECT_DOUBLE_EQ(kept.after, 0.004);
}

/// Where contacts count as touching for as long as a delay asks for, the same rows count with it
/// and without.
RC_GTEST_PROP(ContactReach, MakesRowsTheSameWithADelayAndWithout, ()) {
  const Robot robot = *test::robot({2, 5, Root::floating});
  RC_PRE(!robot.contacts.empty());
  constexpr double rate = 500.0;
  Sample sample = *test::sample(robot);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < 80; ++i) {
    sample.time = static_cast<double>(i) / rate;
    for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
      sample.in_contact[c] = *rc::gen::inRange(0, 5) == 0;
    }
    samples.push_back(sample);
  }
  Recording log(std::move(samples), rate);
  const Found delay = delay_of_torque(1e-4 * *rc::gen::inRange(-180, 181));
  const ContactReach reach = contact_reach({delay}, rate, {});
  log.extend_contacts(reach.before, reach.after);
  const Viewer with(robot, ContactTreatment::project, {delay.effect});
  const Viewer without(robot, ContactTreatment::project, {});
  for (const std::size_t i : log.usable(1)) {
    RC_ASSERT(with.view(log, i).sample.in_contact == without.view(log, i).sample.in_contact);
  }
}

/// A trot's torque three samples late: the loop finds it, and is closed again in logs whose
/// contacts touch for as much longer.
TEST(ContactReach, ALoopWithADelayIsClosedAgain) {
  const Trot trot;
  constexpr std::size_t late = 3;
  std::vector<Sample> samples = trot.samples;
  for (std::size_t i = late; i < samples.size(); ++i) samples[i].tau = trot.samples[i - late].tau;
  const Recording declared(samples, Trot::rate);
  Recording log = declared, other = declared;
  const LoopInReach closed =
      close_loop_in_reach(trot.robot, log, nullptr, {&other, nullptr}, trot.settings());
  ASSERT_EQ(closed.loop.found.size(), 1U);
  EXPECT_EQ(closed.loop.found[0].id, "torque_delay@all");
  EXPECT_NEAR(closed.loop.found[0].effect.value[0], 0.006, 2e-4);
  EXPECT_GE(closed.reach.after, 0.006 - 1e-9);
  EXPECT_LE(closed.reach.after, 0.008 + 1e-9) << "the delay may be found a little longer";
  EXPECT_EQ(closed.reach.before, 0.0);
  for (std::size_t i = late; i < samples.size(); ++i) {
    for (std::size_t c = 0; c < trot.robot.contacts.size(); ++c) {
      const bool touched = declared[i].in_contact[c] || declared[i - late].in_contact[c];
      ASSERT_TRUE(!touched || log[i].in_contact[c]) << i;
      ASSERT_EQ(log[i].in_contact[c], other[i].in_contact[c]) << i;
    }
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
