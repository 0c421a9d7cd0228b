// Bases that are modelled upright and stand any way but upside down.
#include "shapeid/diagnosis/quarter_turns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::effect;
using Ids = std::vector<std::string>;

constexpr double quarter = 0.5 * std::numbers::pi;

TEST(QuarterTurns, OnAWallAndHalfWayThereTheTiltIsFoundBesideFriction) {
  for (const auto& [roll, pitch] :
       {std::pair(quarter, 0.0), {0.0, -quarter}, {-1.0, 0.9}, {0.7, -0.7}, {-1.8, 0.3}}) {
    test::ArmLog log;
    log.effects = {effect("gravity_tilt", 0, {roll, pitch}), effect("viscous_friction", 1, {0.3})};
    const LoopResult result = test::loop_of(test::record(log));
    ASSERT_EQ(test::found_ids(result), (Ids{"gravity_tilt@all", "viscous_friction@joint2"}))
        << roll << " " << pitch;
    for (const Found& f : result.found) {
      EXPECT_TRUE(f.name_stands()) << f.id;
      if (f.id != "gravity_tilt@all") continue;
      constexpr double errors = 5.0;
      EXPECT_LT(std::abs(f.effect.value[0] - roll), errors * f.standard_error[0]) << f.effect.value;
      EXPECT_LT(std::abs(f.effect.value[1] - pitch), errors * f.standard_error[1])
          << f.effect.value;
    }
  }
}

/// A tilt that its derivative leads to is left to it, and a torque that has other causes is no
/// turn.
TEST(QuarterTurns, AreTakenOnlyWhereTheyExplainFarMore) {
  const Robot robot = test::arm();
  const LoopSettings settings = test::arm_settings();
  for (const auto& [effects, turns] :
       {std::pair(std::vector<AppliedEffect>{}, false),
        {{effect("gravity_tilt", 0, {0.3, -0.2})}, false},
        {{effect("torque_offset", 1, {20.0}), effect("viscous_friction", 0, {5.0})}, false},
        {{effect("gravity_tilt", 0, {1.3, 0.1})}, true}}) {
    test::ArmLog log;
    log.effects = effects;
    LoopState state(robot, test::record(log), nullptr, settings);
    try_quarter_turns(state);
    EXPECT_EQ(state.result.found.size(), turns ? 1U : 0U);
    EXPECT_EQ(state.result.model.effects.size(), turns ? 1U : 0U);
  }
}

/// Where all axes are level and links are given four times too heavy, weight along the axes would
/// do less harm.
TEST(QuarterTurns, AreNotTakenForMassesThatAreGivenTooLarge) {
  Robot robot = test::arm();
  robot.links[1].joint.axis = Eigen::Vector3d::UnitY();
  const Recording log = test::moved_as_arm(robot, {});
  for (Link& link : robot.links) link.inertia.values *= 4.0;
  const LoopSettings settings = test::arm_settings();
  LoopState state(robot, log, nullptr, settings);
  try_quarter_turns(state);
  EXPECT_TRUE(state.result.found.empty());
}

}  // namespace
}  // namespace shapeid::diagnosis
