// Flags of contacts that were moved before anything was known, asked again after the loop.
#include "shapeid/diagnosis/contacts_in_loop.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/diagnosis/contact_flags.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

using test::Trot;

/// The base's sensors so many samples late.
std::vector<Sample> late_imu(std::vector<Sample> samples, std::size_t late) {
  for (std::size_t i = samples.size() - 1; i >= late; --i) {
    const Sample& was = samples[i - late];
    samples[i].base_specific_force = was.base_specific_force;
    samples[i].base_angular_velocity = was.base_angular_velocity;
    samples[i].base_angular_acceleration = was.base_angular_acceleration;
  }
  return samples;
}

bool same_contacts(const Recording& a, const Recording& b) {
  for (std::size_t i = 0; i < a.samples().size(); ++i) {
    if (a[i].in_contact != b[i].in_contact) return false;
  }
  return true;
}

/// What a drive of first order with this time constant (s) makes of a joint's torque.
std::vector<Sample> lagging(std::vector<Sample> samples, int joint, double T) {
  const double share = 1.0 / (1.0 + T * Trot::rate);
  double torque = samples.front().tau[joint];
  for (Sample& s : samples) {
    torque += share * (s.tau[joint] - torque);
    s.tau[joint] = torque;
  }
  return samples;
}

/// Beside masses alone forces at a foot explain a part of what its leg's drive lacks: as if its
/// flag went 36 ms before the foot does.
TEST(ContactsInLoop, AFlagThatALagAccusedGoesBack) {
  const Trot trot;
  const LoopSettings settings = trot.settings_for_base();
  const Recording declared(lagging(trot.samples, 6, 0.007), Trot::rate);
  Recording log = declared, other = declared;
  ASSERT_FALSE(correct_contact_flags(trot.robot, log, nullptr, {}, settings).empty());
  log = declared;
  const LoopWithContacts closed =
      close_loop_with_contacts(trot.robot, log, nullptr, {&other, nullptr}, settings);
  EXPECT_TRUE(closed.flags.empty());
  EXPECT_EQ(test::found_ids(closed.loop), std::vector<std::string>{"torque_lag@RR_abad"});
  EXPECT_TRUE(same_contacts(log, declared));
  EXPECT_TRUE(same_contacts(other, declared));
}

/// (A blind trot, seed 9564, trial 11, whose IMU was 0.6 ms late, had a foot that touches 84 ms
/// early in its answer.)
TEST(ContactsInLoop, ALateImuAccusesNoFootThatSwings) {
  const Trot trot;
  Recording log(late_imu(trot.samples, 5), Trot::rate);
  EXPECT_TRUE(
      correct_contact_flags(trot.robot, log, nullptr, {}, trot.settings_for_base()).empty());
}

TEST(ContactsInLoop, AFlagThatIsLateStaysCorrectedBesideALateImu) {
  const Trot trot;
  const Recording told = trot.told(2, 0.016, 0.0);
  const Recording declared(late_imu(told.samples(), 5), Trot::rate);
  Recording log = declared, other = declared;
  const std::vector<Found> at_first =
      correct_contact_flags(trot.robot, log, nullptr, {}, trot.settings_for_base());
  log = declared;
  const LoopWithContacts closed =
      close_loop_with_contacts(trot.robot, log, nullptr, {&other}, trot.settings_for_base());
  ASSERT_EQ(closed.flags.size(), 1U);
  EXPECT_EQ(closed.flags[0].id, "contact_late@RR_foot");
  ASSERT_EQ(at_first.at(0).id, "contact_late@RR_foot");
  EXPECT_GT(closed.flags[0].gain, at_first[0].gain) << "a larger share of what the delay leaves";
  EXPECT_GT(closed.flags[0].t, at_first[0].t);
  EXPECT_NEAR(closed.flags[0].standard_error[0] / closed.flags[0].effect.value[0], 0.25, 1e-12)
      << "times are looked at in steps of one and a half: half of such a step";
  EXPECT_EQ(test::found_ids(closed.loop), std::vector<std::string>{"imu_delay@all"});
  Recording corrected = declared;
  correct_contact_flags(corrected, closed.flags);
  EXPECT_TRUE(same_contacts(log, corrected));
  EXPECT_TRUE(same_contacts(other, corrected));
  EXPECT_FALSE(same_contacts(log, declared));
}

}  // namespace
}  // namespace shapeid::diagnosis
