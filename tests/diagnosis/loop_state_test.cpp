// What the loop keeps between its steps: weights, terms, limits.
#include "shapeid/diagnosis/loop_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

/// The arm's log without noise, but for so many N m at each joint, up and down in turn.
Recording off_by(const Eigen::Vector3d& torque) {
  std::vector<Sample> samples = test::record({{}, 20.0, 0.0}).samples();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].tau += (i / 2 % 2 == 0 ? 1.0 : -1.0) * torque;  // every second one is looked at
  }
  return {std::move(samples), 100.0};
}

struct OnArm {
  explicit OnArm(const Eigen::Vector3d& torque, const Recording* reference = nullptr)
      : log(off_by(torque)), state(robot, log, reference, settings) {}
  Robot robot = test::arm();
  LoopSettings settings = test::arm_settings();
  Recording log;
  LoopState state;
};

TEST(LoopState, WeighsRowsByWhatIsLeftOfThem) {
  OnArm arm(Eigen::Vector3d(0.5, 0.02, 0.001));
  arm.state.reweigh();
  const Eigen::Vector3d weight = arm.state.result.weight;
  // The third fits far better: it is taken for a fiftieth of the mean.
  const double least = 0.02 * (0.5 + 0.02 + 0.001) / 3.0;
  EXPECT_NEAR(weight[0] * std::pow(0.5, 2), 1.0, 1e-9);
  EXPECT_NEAR(weight[1] * std::pow(0.02, 2), 1.0, 1e-9);
  EXPECT_NEAR(weight[2] * std::pow(least, 2), 1.0, 1e-9);
}

/// Links without mass leave nothing of a torque of zero. If its row then weighed as much as floors
/// allow, masses would stay at nothing.
TEST(LoopState, AJointThatNothingDrivesWeighsNoMoreThanAnother) {
  std::vector<Sample> samples = off_by(Eigen::Vector3d(0.1, 0.2, 0.3)).samples();
  for (Sample& s : samples) s.tau[1] = 0.0;
  const Robot robot = test::arm();
  const LoopSettings settings = test::arm_settings();
  const Recording log(std::move(samples), 100.0);
  LoopState state(robot, log, nullptr, settings);
  state.result.model.Phi.setZero();
  state.reweigh();
  const Eigen::Vector3d weight = state.result.weight;
  EXPECT_EQ(weight[1], std::max(weight[0], weight[2]));
}

TEST(LoopState, WeightsOfAnExactLogAreNumbers) {
  OnArm arm(Eigen::Vector3d::Zero());
  ASSERT_EQ(arm.state.left_by(arm.state.result.model).rms().maxCoeff(), 0.0);
  arm.state.reweigh();
  for (const double weight : arm.state.result.weight) {
    EXPECT_GT(weight, 0.0);
    EXPECT_TRUE(std::isfinite(weight)) << weight;
  }
}

TEST(LoopState, AMassIsAsFarOffAboveAsBelow) {
  OnArm arm(Eigen::Vector3d::Zero());
  const double given = arm.robot.links[2].inertia.mass();
  Eigen::VectorXd& Phi = arm.state.result.model.Phi;
  for (const double factor : {4.0, 0.25}) {
    Phi[20] = factor * given;
    EXPECT_NEAR(arm.state.mass_off_by(2), 4.0, 1e-12);
  }
  for (const double none : {0.0, -given}) {
    Phi[20] = none;
    EXPECT_EQ(arm.state.mass_off_by(2), std::numeric_limits<double>::infinity());
  }
  EXPECT_EQ(arm.state.mass_off_by(1), 1.0);
}

/// What came since the reference log has no column in its blocks; what is in both has; a
/// transformation that is applied is fitted along with the masses.
TEST(LoopState, TermsOfTheModelBeginWhereTheirEffectsDo) {
  const Recording reference = test::record({{}, 20.0, 0.02, 2});
  OnArm arm(Eigen::Vector3d(0.02, 0.02, 0.02), &reference);
  AppliedEffect came = test::effect("viscous_friction", 0, {0.2});
  came.when = When::since_reference;
  for (const AppliedEffect& effect : {came, test::effect("viscous_friction", 1, {0.1}),
                                      test::effect("torque_delay", 0, {0.001})}) {
    arm.state.result.found.push_back({effect, "", Eigen::VectorXd::Zero(1)});
  }
  arm.state.collect_effects();
  const BlockFits fits = arm.state.tallied(arm.state.result.model.effects);
  ASSERT_GT(fits.first_block(), 0U);
  const std::vector<Term> terms = arm.state.terms_of_model(fits, 3);
  ASSERT_EQ(terms.size(), 3U);
  EXPECT_EQ(terms[0].from_block, 0U);
  EXPECT_EQ(terms[0].columns.size(), 31U) << "three links and the delay";
  EXPECT_EQ(terms[1].columns.front(), fits.tally().first[0]);
  EXPECT_EQ(terms[1].from_block, fits.first_block());
  EXPECT_EQ(terms[2].columns.front(), fits.tally().first[1]);
  EXPECT_EQ(terms[2].from_block, 0U);
  EXPECT_EQ(arm.state.terms_of_model(fits, 1).size(), 2U);
  EXPECT_EQ(arm.state.result.model.in_reference().acting().size(), 2U);
  EXPECT_EQ(arm.state.result.model.acting().size(), 3U);
}

/// A tilt that is not there: a step from it leads back, and as it is it ruins everything.
TEST(LoopState, WhatIsWrittenIsJudgedWithoutAFurtherStep) {
  OnArm arm(Eigen::Vector3d(0.02, 0.02, 0.02));
  const LoopState::HeldOut none = arm.state.held_out_either_way();
  EXPECT_EQ(none.as_written, none.moved_on) << "nothing is applied";
  EXPECT_EQ(none.moved_on, arm.state.held_out_of_model());
  const AppliedEffect tilt = test::effect("gravity_tilt", 0, {0.1, -0.05});
  arm.state.result.found.push_back({tilt, "", Eigen::VectorXd::Zero(2)});
  arm.state.collect_effects();
  const LoopState::HeldOut tilted = arm.state.held_out_either_way();
  EXPECT_EQ(tilted.moved_on, arm.state.held_out_of_model());
  EXPECT_GT(tilted.as_written.sum(), 10.0 * none.as_written.sum());
  EXPECT_LT(tilted.moved_on.sum(), 0.1 * tilted.as_written.sum());
}

TEST(LoopState, TransformationsStayWithinTheirLimitsAndOthersNeedNot) {
  OnArm arm(Eigen::Vector3d::Zero());
  const AppliedEffect late = test::effect("torque_delay", 0, {-50.0}),
                      rough = test::effect("viscous_friction", 1, {1e6});
  for (const AppliedEffect& effect : {late, rough}) {
    arm.state.result.found.push_back({effect, "", Eigen::VectorXd::Zero(1)});
  }
  arm.state.collect_effects();
  EXPECT_EQ(arm.state.result.model.effects[0].value[0], -late.effect->parameters[0].limit);
  EXPECT_EQ(arm.state.result.found[0].effect.value[0], -late.effect->parameters[0].limit);
  EXPECT_EQ(arm.state.result.model.effects[1].value[0], 1e6);
}

TEST(LoopState, NoForceIsBelievedBeyondTheRobotsWeight) {
  OnArm arm(Eigen::Vector3d::Zero());
  double mass = 0.0;
  for (const Link& link : arm.robot.links) mass += link.inertia.mass();
  arm.settings.expected_mass = 0.5 * mass;
  arm.settings.rule.most_force = 1e9;
  EXPECT_NEAR(arm.state.rule().most_force, 9.81 * mass, 1e-9);
  arm.settings.expected_mass = 2.0 * mass;
  EXPECT_NEAR(arm.state.rule().most_force, 9.81 * 2.0 * mass, 1e-9);
  arm.settings.rule.most_force = 1.0;
  EXPECT_EQ(arm.state.rule().most_force, 1.0);
}

}  // namespace
}  // namespace shapeid::diagnosis
