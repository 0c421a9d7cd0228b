// Laws that make up for the wrong shape of another go; those that act stay, as they were.
#include "shapeid/diagnosis/remainders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/refit.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

AppliedEffect shaped(const std::string& id, int site, const std::vector<double>& value,
                     const std::vector<double>& shape) {
  AppliedEffect a = test::effect(id, site, value);
  a.shape = Eigen::Map<const Eigen::VectorXd>(shape.data(), std::ssize(shape));
  return a;
}

/// A loop that has come to these, each of which gains less than the one before.
class Arrived {
 public:
  Arrived(const std::vector<AppliedEffect>& truth, const std::vector<AppliedEffect>& found)
      : log_(test::record({truth})), state(robot_, log_, nullptr, settings_) {
    state.fit_masses();
    state.reweigh();
    double gain = 0.5;
    for (const AppliedEffect& a : found) {
      Found& f = state.result.found.emplace_back(
          Found{a, hypothesis_id(robot_, a), Eigen::VectorXd::Zero(a.value.size())});
      f.gain = gain;
      gain *= 0.8;
    }
    state.collect_effects();
    refit_numbers(state);
  }

  [[nodiscard]] std::vector<std::string> left_out() {
    std::vector<std::string> ids;
    while (const std::optional<AppliedEffect> a = leave_out_remainder(state)) {
      ids.push_back(hypothesis_id(robot_, *a));
    }
    return ids;
  }

 private:
  Robot robot_ = test::arm();
  LoopSettings settings_ = test::arm_settings();
  Recording log_;

 public:
  LoopState state;
};

using Ids = std::vector<std::string>;

TEST(Remainders, ASpringGoesOnceTheRippleHasItsPeriod) {
  for (const double wrong : {10.0, 17.0, 23.0}) {
    Arrived arm(
        {shaped("cogging", 1, {0.8, -0.5}, {14.0})},
        {shaped("cogging", 1, {0.0, 0.0}, {wrong}), test::effect("joint_spring", 1, {0, 0})});
    EXPECT_EQ(arm.left_out(), Ids{"joint_spring@joint2"}) << wrong;
    EXPECT_EQ(test::found_ids(arm.state.result), Ids{"cogging@joint2"}) << wrong;
    const AppliedEffect& ripple = arm.state.result.model.effects.at(0);
    EXPECT_NEAR(ripple.shape[0], 14.0, 0.05) << wrong;
    EXPECT_NEAR(ripple.value[0], 0.8, 0.02) << wrong;
    EXPECT_NEAR(ripple.value[1], -0.5, 0.02) << wrong;
  }
}

/// In whatever order they were found.
TEST(Remainders, TheWeakestGoesFirst) {
  Arrived arm({shaped("cogging", 1, {0.8, -0.5}, {14.0})},
              {shaped("cogging", 1, {0.0, 0.0}, {17.0}), test::effect("joint_spring", 1, {0, 0}),
               test::effect("viscous_friction", 1, {0.0})});
  std::ranges::reverse(arm.state.result.found);
  arm.state.collect_effects();
  EXPECT_EQ(arm.left_out(), (Ids{"viscous_friction@joint2", "joint_spring@joint2"}));
  EXPECT_EQ(test::found_ids(arm.state.result), Ids{"cogging@joint2"});
}

TEST(Remainders, ASecondFrictionGoesOnceTheFirstIsAsSteepAsItIs) {
  Arrived arm({shaped("load_friction", 1, {0.08}, {0.01})},
              {shaped("load_friction", 1, {0.0}, {0.2}),
               shaped("stribeck_friction", 1, {0.0}, {0.2, 0.01})});
  EXPECT_EQ(arm.left_out(), Ids{"stribeck_friction@joint2"});
  EXPECT_EQ(test::found_ids(arm.state.result), Ids{"load_friction@joint2"});
}

/// Also the weakest of several at a joint is asked, and nothing of those that stay is changed.
TEST(Remainders, WhatActsStays) {
  const std::vector<AppliedEffect> truth = {
      shaped("cogging", 1, {0.8, -0.5}, {14.0}), test::effect("viscous_friction", 1, {0.2}),
      test::effect("joint_spring", 1, {2.0, 0.3}), shaped("coulomb_friction", 1, {0.2}, {0.05}),
      test::effect("viscous_friction", 2, {0.05})};
  Arrived arm(truth, truth);
  const Eigen::VectorXd Phi = arm.state.result.model.Phi;
  const auto found = arm.state.result.found;
  EXPECT_EQ(arm.left_out(), Ids{});
  EXPECT_EQ(arm.state.result.model.Phi, Phi);
  ASSERT_EQ(arm.state.result.found.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(arm.state.result.found[i].id, found[i].id);
    EXPECT_EQ(arm.state.result.found[i].effect.value, found[i].effect.value);
    EXPECT_EQ(arm.state.result.found[i].effect.shape, found[i].effect.shape);
  }
}

/// A friction so small that it gains less than two standard errors, whatever it was said to have
/// gained, is a remainder only if that was three times as much.
TEST(Remainders, WhatKeepsMostOfItsGainStays) {
  const std::vector<AppliedEffect> found = {shaped("cogging", 1, {0.0, 0.0}, {14.0}),
                                            test::effect("viscous_friction", 1, {0.0})};
  Arrived arm(
      {shaped("cogging", 1, {0.8, -0.5}, {14.0}), test::effect("viscous_friction", 1, {0.0014})},
      found);
  const LoopResult before = arm.state.result;
  const Eigen::VectorXd with = arm.state.held_out_of_model();
  arm.state.result.found.pop_back();
  arm.state.collect_effects();
  refit_numbers(arm.state);
  const Gain gain = gain_of(arm.state.held_out_of_model(), with);
  ASSERT_GT(gain.share, 0.0);
  ASSERT_LT(gain.t, keep_t);
  for (const double times : {2.5, 4.0}) {
    arm.state.result = before;
    arm.state.result.found[1].gain = times * gain.share;
    EXPECT_EQ(arm.left_out().size(), times > 3.0 ? 1u : 0u) << times;
  }
}

/// Each that stays costs a refit: of these the fourth is a remainder, and nobody asks.
TEST(Remainders, AfterThreeThatStayNoneIsAsked) {
  for (const bool fourth : {false, true}) {
    std::vector<AppliedEffect> truth = {shaped("cogging", 1, {0.8, -0.5}, {14.0}),
                                        test::effect("joint_spring", 1, {2.0, 0.3}),
                                        shaped("coulomb_friction", 1, {0.2}, {0.05})};
    if (fourth) truth.push_back(test::effect("viscous_friction", 1, {0.2}));
    std::vector<AppliedEffect> found = truth;
    found.insert(found.begin() + 1, shaped("load_friction", 1, {0.0}, {0.05}));
    Arrived arm(truth, found);
    EXPECT_EQ(arm.left_out(), fourth ? Ids{} : Ids{"load_friction@joint2"});
  }
}

/// What came since a reference log is of that one, and no part of what always acts.
TEST(Remainders, WhatCameSinceTheReferenceStays) {
  Arrived arm({shaped("cogging", 1, {0.8, -0.5}, {14.0})},
              {shaped("cogging", 1, {0.0, 0.0}, {14.0}), test::effect("torque_offset", 1, {0.0})});
  arm.state.result.found[1].effect.when = When::since_reference;
  EXPECT_EQ(arm.left_out(), Ids{});
  arm.state.result.found[1].effect.when = When::always;
  EXPECT_EQ(arm.left_out(), Ids{"torque_offset@joint2"});
}

/// What is no law of the ripple's own joint was no remainder of it, nor what is stronger than all
/// that has a shape; though none of these acts.
TEST(Remainders, OnlyWeakerLawsOfTheSameJointAreAsked) {
  Arrived arm({shaped("cogging", 1, {0.8, -0.5}, {14.0})},
              {test::effect("torque_offset", 1, {0.0}), shaped("cogging", 1, {0.0, 0.0}, {14.0}),
               test::effect("viscous_friction", 2, {0.0}), test::effect("torque_offset", 2, {0.0}),
               test::effect("encoder_offset", 1, {0.0}),
               test::effect("external_force", 1, {0.0, 0.0, 0.0})});
  EXPECT_EQ(arm.left_out(), Ids{});
  EXPECT_EQ(arm.state.result.found.size(), 6u);
}

}  // namespace
}  // namespace shapeid::diagnosis
