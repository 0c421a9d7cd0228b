// Rotors that free parameters take over and bodies cannot.
#include "shapeid/diagnosis/needed.hpp"

#include <gtest/gtest.h>

#include "shapeid/diagnosis/unnoticed.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

struct Diagnosed {
  LoopResult loop;
  Consistent before, after;
};

Diagnosed diagnosed(double rotor, std::uint32_t seed) {
  test::ArmLog what;
  if (rotor > 0.0) what.effects = {test::effect("rotor_inertia", 0, {rotor})};
  what.seed = seed;
  const Recording log = test::record(what);
  const LoopSettings settings = test::arm_settings();
  const Robot robot = test::arm();
  Diagnosed result{test::loop_of(log), {}, {}};
  result.before = make_consistent(robot, log, nullptr, settings, result.loop);
  result.after = result.before;
  add_needed_rotors(robot, log, nullptr, settings, result.loop, result.after);
  return result;
}

/// The first joint's rotor cannot be told from the inertia about its axis of all that it turns.
TEST(NeededRotors, ABodyDoesNotGrowHeavyForARotor) {
  const Robot robot = test::arm();
  constexpr double truth = 3.0;  // kg m^2, of links with some 0.1
  const Diagnosed d = diagnosed(truth, 3);
  bool far = false;
  for (const int link : {1, 2, 3}) {
    far = far || is_far_from_given(robot, d.before, d.before.Phi_error, link);
    EXPECT_FALSE(is_far_from_given(robot, d.after, d.after.Phi_error, link)) << link;
  }
  EXPECT_TRUE(far) << "what is to be mended was not there";
  ASSERT_FALSE(d.loop.found.empty());
  const Found& rotor = d.loop.found.back();
  EXPECT_EQ(rotor.id, "rotor_inertia@joint1");
  EXPECT_TRUE(rotor.needed);
  EXPECT_FALSE(rotor.name_stands()) << "larger links would do as well";
  EXPECT_NEAR(rotor.effect.value[0], truth, 0.1 * truth);
  ASSERT_EQ(d.after.model.effects.size(), d.after.effect_error.size());
  EXPECT_EQ(d.after.model.effects.back().value, rotor.effect.value);
}

TEST(NeededRotors, NoneIsAddedWhereBodiesDo) {
  for (const std::uint32_t seed : {1U, 2U}) {
    const Diagnosed d = diagnosed(0.0, seed);
    EXPECT_TRUE(d.loop.found.empty());
    EXPECT_EQ(d.after.model.Phi, d.before.model.Phi);
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
