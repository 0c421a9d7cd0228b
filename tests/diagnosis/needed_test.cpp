// Causes that free parameters take over and bodies cannot. (Forces of which no body can be made
// come with drawn arms: Blind.AForceThatNoBodySays.)
#include "shapeid/diagnosis/needed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/diagnosis/unnoticed.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

struct Diagnosed {
  LoopResult loop;
  Consistent before, after;
};

Diagnosed diagnosed(double rotor, std::uint32_t seed, decltype(add_needed_rotors)* add) {
  test::ArmLog what;
  if (rotor > 0.0) what.effects = {test::effect("rotor_inertia", 0, {rotor})};
  what.seed = seed;
  const Recording log = test::record(what);
  const LoopSettings settings = test::arm_settings();
  const Robot robot = test::arm();
  Diagnosed result{test::loop_of(log), {}, {}};
  result.before = make_consistent(robot, log, nullptr, settings, result.loop);
  result.after = result.before;
  add(robot, log, nullptr, settings, result.loop, result.after);
  return result;
}

/// The first joint's rotor cannot be told from the inertia about its axis of all that it turns.
TEST(NeededRotors, ABodyDoesNotGrowHeavyForARotor) {
  const Robot robot = test::arm();
  constexpr double truth = 3.0;  // kg m^2, of links with some 0.1
  const Diagnosed d = diagnosed(truth, 3, add_needed_rotors);
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
  EXPECT_EQ(d.after.model.effects.size(), d.loop.found.size()) << "those that stay";
  EXPECT_EQ(d.after.model.effects.back().value, rotor.effect.value);
}

/// One link sought: the only rotor that is tried stays.
TEST(NeededRotors, OfOneJointIsTriedOnce) {
  const Robot robot = test::arm();
  const Recording log = test::record({{test::effect("rotor_inertia", 0, {3.0})}});
  LoopSettings settings = test::arm_settings();
  settings.shapes = generous_regions(robot, {1});
  settings.expected_mass = 2.0;
  LoopResult loop = close_loop(robot, log, nullptr, settings);
  Consistent bodies = make_consistent(robot, log, nullptr, settings, loop);
  ASSERT_TRUE(is_far_from_given(robot, bodies, bodies.Phi_error, 1));
  add_needed_rotors(robot, log, nullptr, settings, loop, bodies);
  EXPECT_EQ(test::found_ids(loop), std::vector<std::string>{"rotor_inertia@joint1"});
  EXPECT_FALSE(is_far_from_given(robot, bodies, bodies.Phi_error, 1));
}

/// Beside a rotor that was found another one may lack: none comes in twice.
TEST(NeededRotors, AreNoneThatTheModelHas) {
  const AppliedEffect first = test::effect("rotor_inertia", 0, {3.0});
  const Recording log = test::record({{first, test::effect("rotor_inertia", 1, {2.0})}});
  const LoopSettings settings = test::arm_settings();
  const Robot robot = test::arm();
  LoopResult loop = test::loop_of(log);
  loop.found = {{first, "rotor_inertia@joint1", Eigen::VectorXd::Constant(1, 0.1)}};
  loop.model.effects = {first};
  Consistent bodies = make_consistent(robot, log, nullptr, settings, loop);
  add_needed_rotors(robot, log, nullptr, settings, loop, bodies);
  EXPECT_EQ(test::found_ids(loop),
            (std::vector<std::string>{"rotor_inertia@joint1", "rotor_inertia@joint2"}));
}

/// Such links fit worse than free numbers do, and of all that these hide the rotor mends it.
TEST(NeededCauses, WhatBodiesLackIsFoundAmongWhatFreeNumbersHide) {
  constexpr double truth = 3.0;
  const Diagnosed d = diagnosed(truth, 3, add_needed_causes);
  ASSERT_EQ(d.loop.found.size(), 1U);
  const Found& rotor = d.loop.found.front();
  EXPECT_EQ(rotor.id, "rotor_inertia@joint1");
  EXPECT_NEAR(rotor.effect.value[0], truth, 0.01 * truth);
  EXPECT_GT(rotor.gain, 0.0);
  EXPECT_FALSE(rotor.name_stands()) << "larger links would do as well";
  EXPECT_EQ(std::count(d.loop.hidden.begin(), d.loop.hidden.end(), rotor.id), 0);
  EXPECT_TRUE(rotor.ambiguous_with.empty()) << rotor.ambiguous_with.front();
  ASSERT_EQ(d.after.model.effects.size(), 1U);
  EXPECT_EQ(d.after.model.effects[0].value, rotor.effect.value);
}

TEST(Needed, NothingIsAddedWhereBodiesDo) {
  for (const auto add : {add_needed_rotors, add_needed_causes}) {
    for (const std::uint32_t seed : {1U, 2U}) {
      const Diagnosed d = diagnosed(0.0, seed, add);
      ASSERT_FALSE(d.loop.hidden.empty());
      EXPECT_TRUE(d.loop.found.empty());
      EXPECT_EQ(d.after.model.Phi, d.before.model.Phi);
    }
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
