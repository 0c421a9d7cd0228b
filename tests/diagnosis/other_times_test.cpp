// What a log and its reference know each, and not both.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::effect;

/// The arm's log on another motion, with the torque that goes with that; 20 s, noise of 0.02 N m.
Recording moved_otherwise(std::uint32_t seed, const std::vector<AppliedEffect>& effects,
                          const std::function<void(Sample&)>& motion,
                          const std::function<void(Sample&)>& torque) {
  std::vector<Sample> samples = test::record({{}, 20.0, 0.0, seed}).samples();
  for (Sample& s : samples) motion(s);
  const Robot robot = arm();
  const RichModel truth{stacked_parameters(robot), effects};
  const Recording bare(samples, 100.0);
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  test::Draw draw(seed);
  const std::vector<std::size_t> usable = bare.usable(1);
  for (const std::size_t i : usable) {
    samples[i].tau = predict(viewer, viewer.view(bare, i), truth).force;
    torque(samples[i]);
    for (double& tau : samples[i].tau) tau += 0.02 * draw.normal();
  }
  return {{samples.begin() + static_cast<std::ptrdiff_t>(usable.front()),
           samples.begin() + static_cast<std::ptrdiff_t>(usable.back()) + 1},
          100.0};
}

Recording moving(std::uint32_t seed, const std::vector<AppliedEffect>& effects) {
  return moved_otherwise(
      seed, effects, [](Sample&) {}, [](Sample&) {});
}

/// Joint 3 does not move, and nothing of it shows.
Recording standing(std::uint32_t seed, const std::vector<AppliedEffect>& effects) {
  const auto stand = [](Sample& s) {
    s.q[2] = 0.7;
    s.dq[2] = s.ddq[2] = 0.0;
  };
  return moved_otherwise(seed, effects, stand, [](Sample&) {});
}

LoopResult loop_of(const Recording& log, const Recording& reference) {
  return close_loop(arm(), log, &reference, test::arm_settings());
}

/// In the log joint 3 stands still: there its friction is hidden, and all that is known of it is in
/// the reference. (It was listed as hidden, twice, beside the finding.)
TEST(OtherTimes, WhatTheReferenceKnowsIsNotHidden) {
  const std::vector<AppliedEffect> effects = {effect("viscous_friction", 2, {0.4}),
                                              effect("viscous_friction", 1, {0.3})};
  for (const bool in_log : {true, false}) {
    const Recording still = standing(2, effects), moves = moving(1, effects);
    const LoopResult result = in_log ? loop_of(still, moves) : loop_of(moves, still);
    ASSERT_EQ(test::found_ids(result),
              (std::vector<std::string>{"viscous_friction@joint2", "viscous_friction@joint3"}));
    std::vector<std::string> hidden = result.hidden;
    for (const char* known : {"viscous_friction@joint3", "coulomb_friction@joint3",
                              "torque_offset@joint3", "joint_spring@joint3"}) {
      EXPECT_EQ(std::ranges::count(hidden, known), 0) << known << " " << in_log;
    }
    EXPECT_EQ(std::ranges::count(hidden, "rotor_inertia@joint1"), 1)
        << "a rotor and its link's inertia about the axis are one number in either log";
    std::ranges::sort(hidden);
    EXPECT_TRUE(std::ranges::adjacent_find(hidden) == hidden.end());
  }
}

/// A gain of a joint that stands in one of the logs: there it came or went as well as not, and that
/// is no other cause.
TEST(OtherTimes, AGainIsNotAmbiguousWithItself) {
  const std::vector<AppliedEffect> effects = {effect("torque_gain", 2, {0.3})};
  for (const bool in_log : {true, false}) {
    const Recording still = standing(2, effects), moves = moving(1, effects);
    const LoopResult result = in_log ? loop_of(still, moves) : loop_of(moves, still);
    ASSERT_EQ(test::found_ids(result), std::vector<std::string>{"torque_gain@joint3"});
    const Found& gain = result.found.front();
    EXPECT_EQ(std::ranges::count(gain.ambiguous_with, gain.id), 0) << in_log;
    EXPECT_EQ(std::ranges::count(gain.exchangeable, gain.id), 0) << in_log;
  }
}

/// A ripple over another joint's position, where both joints move nearly alike, is no cogging:
/// neither where it came nor where it went. (A name that went was questioned in the log, where
/// nothing of it is.)
TEST(OtherTimes, ARippleThatWentIsQuestionedWhereItWas) {
  constexpr double own = 0.05;  // of joint 3's motion beside joint 2's
  const auto alike = [](Sample& s) {
    for (Eigen::VectorXd* v : {&s.q, &s.dq, &s.ddq}) (*v)[2] = (*v)[1] + own * (*v)[2];
  };
  const auto ripple = [](Sample& s) { s.tau[2] += 0.1 * std::sin(14.0 * s.q[1] + 0.3); };
  const Recording with = moved_otherwise(1, {}, alike, ripple);
  const Recording without = moved_otherwise(2, {}, alike, [](Sample&) {});
  for (const bool came : {true, false}) {
    const LoopResult result = came ? loop_of(with, without) : loop_of(without, with);
    for (const Found& f : result.found) {
      if (f.id != "cogging@joint3") continue;
      EXPECT_EQ(f.effect.when, came ? When::since_reference : When::gone);
      EXPECT_TRUE(f.any_period) << came;
      EXPECT_FALSE(f.name_stands()) << came;
    }
    EXPECT_EQ(std::ranges::count(test::found_ids(result), "cogging@joint3"), 1) << came;
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
