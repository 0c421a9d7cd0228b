// What is said of inertias: which the data determine, and which hang on effects that are no causes.
#include "shapeid/diagnosis/causes_alone.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::record;

struct LoopedArm {
  LoopSettings settings = arm_settings();
  Recording log;
  LoopResult loop;

  explicit LoopedArm(const Recording& recording)
      : log(recording), loop(close_loop(arm(), log, nullptr, settings)) {}

  [[nodiscard]] Consistent consistent() const {
    return make_consistent(arm(), log, nullptr, settings, loop);
  }
  [[nodiscard]] std::optional<Consistent> causes_alone() const {
    return beside_causes_alone(arm(), log, nullptr, settings, loop);
  }
};

bool some_link_hangs(const Consistent& model, const Consistent& causes_alone) {
  for (int link = 1; link < 4; ++link) {
    if (hangs_on_descriptions(model, causes_alone, link)) return true;
  }
  return false;
}

TEST(CausesAlone, NothingIsFittedAgainWhereEveryNameStands) {
  const LoopedArm fitted(record({{effect("viscous_friction", 1, {0.3})}}));
  ASSERT_EQ(fitted.loop.found.size(), 1U);
  EXPECT_FALSE(fitted.causes_alone());
}

TEST(CausesAlone, MassesThatADescriptionCarriesAreNotIdentified) {
  LoopedArm fitted(record({{effect("joint_spring", 1, {4.0, 2.0})}}));
  ASSERT_EQ(fitted.loop.found.size(), 1U);
  const Consistent model = fitted.consistent();
  fitted.loop.found[0].displaced = true;
  const std::optional<Consistent> alone = fitted.causes_alone();
  ASSERT_TRUE(alone);
  EXPECT_TRUE(alone->model.effects.empty());
  EXPECT_TRUE(some_link_hangs(model, *alone));
}

TEST(CausesAlone, ADescriptionOfNothingCarriesNone) {
  LoopedArm fitted(record({}));
  Found nothing{effect("viscous_friction", 1, {0.0}), "viscous_friction@joint2",
                Eigen::VectorXd::Zero(1)};
  nothing.drowned = true;
  fitted.loop.found = {nothing};
  fitted.loop.model.effects = {nothing.effect};
  const Consistent model = fitted.consistent();
  const std::optional<Consistent> alone = fitted.causes_alone();
  ASSERT_TRUE(alone);
  ASSERT_EQ(model.model.effects.size(), 1U);
  EXPECT_TRUE(alone->model.effects.empty());
  EXPECT_FALSE(some_link_hangs(model, *alone));
}

/// What stays in is what is a cause, and has the value that it has in the model.
TEST(CausesAlone, CausesStay) {
  LoopedArm fitted(
      record({{effect("viscous_friction", 0, {0.4}), effect("viscous_friction", 1, {0.3})}}));
  ASSERT_EQ(fitted.loop.found.size(), 2U);
  fitted.loop.found[0].varies = Variation{};
  const std::optional<Consistent> alone = fitted.causes_alone();
  ASSERT_TRUE(alone);
  ASSERT_EQ(alone->model.effects.size(), 1U);
  EXPECT_EQ(alone->model.effects[0].site, fitted.loop.found[1].effect.site);
  EXPECT_LT(std::abs(alone->model.effects[0].value[0] - 0.35), 0.1);
}

/// The first link turns about a vertical axis: its mass is seen by no joint. The last one is
/// lifted.
TEST(Consistent, SaysWhatTheDataDetermine) {
  const Consistent result = LoopedArm(record({})).consistent();
  ASSERT_EQ(result.data.determined.size(), 30U);
  EXPECT_FALSE(result.data.determined[0]);
  EXPECT_FALSE(result.data.determined[3]) << "m rz along the axis";
  EXPECT_TRUE(result.data.determined[21]) << "m rx of the last link";
  EXPECT_TRUE(result.data.determined[23]) << "m rz of the last link";
}

TEST(Consistent, TheDatasOwnErrorsGrowWithTheirNoise) {
  const double quiet = LoopedArm(record({{}, 20.0, 0.02, 3})).consistent().data.standard_error[23];
  const double loud = LoopedArm(record({{}, 20.0, 0.08, 3})).consistent().data.standard_error[23];
  EXPECT_GT(loud, 2.5 * quiet);
  EXPECT_LT(loud, 6.0 * quiet) << "four times the noise";
}

/// An effect that says the same as a link leaves nothing of it to be determined: that the load is
/// the load and the link as given is the prior's word.
TEST(Consistent, WhatAnEffectContainsIsNotDetermined) {
  const AppliedEffect load =
      effect("payload", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  LoopedArm fitted(record({{load}}));
  fitted.loop.found = {Found{load, "payload@link3", Eigen::VectorXd::Zero(10)}};
  fitted.loop.model.effects = {load};
  const Consistent result = fitted.consistent();
  ASSERT_TRUE(result.dropped.empty());
  ASSERT_EQ(result.data.determined.size(), 30U);
  for (std::size_t p = 20; p < 30; ++p) EXPECT_FALSE(result.data.determined[p]) << p;
}

/// All joints in one plane: no torque tells how far the base leans out of it, and zero with an
/// error of zero would say that it is known.
TEST(Consistent, ANumberThatNoRowFeelsHasNoError) {
  LoopedArm fitted(record({}));
  const AppliedEffect tilt = effect("gravity_tilt", 0, {0.0, 0.01});
  fitted.loop.found = {Found{tilt, "gravity_tilt@all", Eigen::Vector2d(0.0, 0.001)}};
  fitted.loop.model.effects = {tilt};
  const Consistent result = fitted.consistent();
  ASSERT_EQ(result.effect_error.size(), 1U);
  EXPECT_TRUE(std::isinf(result.effect_error[0][0]));
  EXPECT_EQ(result.effect_error[0][1], 0.001);
}

}  // namespace
}  // namespace shapeid::diagnosis
