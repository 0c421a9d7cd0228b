// Causes without a name that several names, or one that only resembles them, could be put together
// for; and what asks a name for more evidence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/placebo.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/strangers.hpp"
#include "shapeid/diagnosis/unexplained.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::before_a_gear;
using test::effect;
using test::loop_of;
using test::record;

using Joints = std::vector<bool>;

void change_each(std::vector<Sample>& samples, void (*change)(Sample&)) {
  for (Sample& s : samples) change(s);
}

void expect_one_gear(const LoopResult& result, Signal signal) {
  for (const Found& f : result.found) EXPECT_FALSE(f.name_stands()) << f.id;
  ASSERT_FALSE(result.strangers.empty());
  const Stranger& law = result.strangers.front();
  EXPECT_EQ(law.carrier.effect->id, "gear");
  EXPECT_EQ(law.law.signal, signal);
  EXPECT_EQ(law.law.joint, 1);
}

/// Gains, lengths and offsets of several joints together do what this one law does.
TEST(Unnamed, ElasticGearIsNotSeveralNames) {
  const LoopResult result = loop_of(before_a_gear([](double torque) { return 0.0005 * torque; }));
  expect_one_gear(result, Signal::yield);
  EXPECT_EQ(law_text(result.strangers.front(), arm()), "gear@joint2 that yields");
}

TEST(Unnamed, PlayOfAGearIsSeen) {
  const LoopResult result =
      loop_of(before_a_gear([](double torque) { return 0.0002 * std::tanh(torque / 0.1); }));
  expect_one_gear(result, Signal::play);
  EXPECT_EQ(law_text(result.strangers.front(), arm()), "gear@joint2 with play");
}

/// The curve of a gear is how far the encoder is ahead of the joint, over the load.
TEST(Unnamed, GearsNumberIsWhatTheGearYields) {
  const Recording log = before_a_gear([](double torque) { return 0.0005 * torque; });
  const LoopResult result = loop_of(log);
  ASSERT_FALSE(result.strangers.empty());
  const Stranger& law = result.strangers.front();
  EXPECT_GT(law.number, 0.0004);
  EXPECT_LT(law.number, 0.0006);
  const Structure curve = lawless(arm(), ContactTreatment::ignore, result.model, log, 2, law);
  EXPECT_EQ(curve.law, "gear@joint2 that yields");
  EXPECT_EQ(curve.law_unit, "rad");
  ASSERT_GT(curve.at.size(), 1U);
  ASSERT_EQ(curve.value.size(), curve.at.size());
  for (std::size_t i = 0; i < curve.at.size(); ++i) {
    EXPECT_NEAR(curve.value[i], law.number * curve.at[i], 1e-12);
  }
}

/// Noise of torque goes against its own second derivative, as the load of a gear does: on a clean
/// log no gear may be seen for that, not at a joint that is loaded and not at one that is not.
TEST(Unnamed, NoiseIsNoGear) {
  for (const double noise : {0.02, 0.2}) {
    EXPECT_TRUE(loop_of(record({{}, 20.0, noise, 7})).strangers.empty()) << noise;
  }
}

/// Behind a slow filter noise remembers itself for longer, and readings further away are taken.
TEST(Unnamed, FilteredNoiseIsNoGear) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise(0.0, 0.3);
  const std::vector<Sample> quiet = record({{}, 20.0, 0.0}).samples();
  const Recording log = record({}, [&](std::vector<Sample>& samples) {
    constexpr std::size_t reach = 5;  // samples: 50 ms
    Eigen::Matrix3Xd white(3, 2 * std::ssize(samples));
    for (double& w : white.reshaped()) w = noise(generator);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].tau = quiet[i].tau;
      for (std::size_t k = 0; k <= 2 * reach; ++k) {
        const double share = std::cos(0.785 * (static_cast<double>(k) / reach - 1.0));
        samples[i].tau += share / reach * white.col(static_cast<Eigen::Index>(i + k));
      }
    }
  });
  LoopSettings settings = test::arm_settings();
  settings.margin = 0.1;
  for (const Stranger& s : close_loop(arm(), log, nullptr, settings).strangers) {
    EXPECT_NE(s.carrier.effect->id, "gear") << law_text(s, arm());
  }
}

/// A ripple in proportion to the load is none of the position alone, and none of the load alone.
TEST(Unnamed, EccentricGearIsNoRippleAndNoGain) {
  const LoopResult result = loop_of(record({}, [](std::vector<Sample>& samples) {
    change_each(samples, [](Sample& s) { s.tau[1] *= 1.0 + 0.03 * std::sin(9.0 * s.q[1] + 0.7); });
  }));
  for (const Found& f : result.found) EXPECT_FALSE(f.name_stands()) << f.id;
  ASSERT_FALSE(result.strangers.empty());
  const Stranger& law = result.strangers.front();
  EXPECT_EQ(law.carrier.effect->id, "cogging");
  EXPECT_EQ(law.law.signal, Signal::load);
  EXPECT_EQ(law.law.joint, 1);
  constexpr double resolved = 0.5;  // 1/rad: a quarter of a period over the joint's range
  EXPECT_LT(std::abs(law.carrier.shape[0] - 9.0), resolved);
}

/// A sensor that reads no more than so much is no gain: it is one where the load is high.
TEST(Unnamed, WhatSaturatesIsAGainOfPeaks) {
  const LoopResult result = loop_of(record({}, [](std::vector<Sample>& samples) {
    double most = 0.0;
    for (const Sample& s : samples) most = std::max(most, std::abs(s.tau[1]));
    const double limit = 0.85 * most;
    for (Sample& s : samples) s.tau[1] = std::clamp(s.tau[1], -limit, limit);
  }));
  for (const Found& f : result.found) EXPECT_FALSE(f.name_stands()) << f.id;
  ASSERT_FALSE(result.strangers.empty());
  const Stranger& law = result.strangers.front();
  EXPECT_EQ(law.carrier.effect->id, "torque_gain");
  EXPECT_EQ(law.law.signal, Signal::peak);
  EXPECT_EQ(law.law.joint, 1);
}

TEST(Unnamed, RippleThatIsThereKeepsItsName) {
  const LoopResult result = loop_of(record({{effect("cogging", 1, {0.08, 0.06})}}));
  ASSERT_EQ(result.found.size(), 1U);
  EXPECT_EQ(result.found[0].id, "cogging@joint2");
  EXPECT_TRUE(result.found[0].name_stands());
}

TEST(RipplePlacebos, AreOverThePositionOfEveryOtherJoint) {
  const Robot robot = arm();
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    change_each(samples, [](Sample& s) { s.tau[1] += 0.3 * std::cos(20.0 * s.q[2]); });
  });
  const RichModel model{stacked_parameters(robot), {}};
  const Series left = series(robot, ContactTreatment::ignore, model, log, 2);
  const auto list = ripple_placebos(robot, log, left, 1);
  ASSERT_EQ(list.size(), 2U);
  for (const AppliedEffect& a : list) EXPECT_EQ(joint_of_placebo(robot, a), 1);
  // The period of what joint 3 leaves in the row of joint 2 is found.
  constexpr double resolved = 0.5;
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [&](const AppliedEffect& a) {
    return std::abs(a.shape[0] - 20.0) < resolved;
  }));
}

/// An effect of no joint that varies with time is drawn at the joint where most is left, and not at
/// all where nothing counts.
TEST(Unnamed, WhatIsOfNoJointIsDrawnWhereMostIsLeft) {
  const Robot robot = arm();
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[1] += 0.2 * std::sin(s.time);
  });
  const RichModel model{stacked_parameters(robot), {}};
  Series left = series(robot, ContactTreatment::ignore, model, log, 2);
  const Variation varies{Signal::time, -1, 0.3, 9.0};
  const Structure drawn = unnamed(robot, log, left, varies);
  EXPECT_EQ(drawn.joint, "joint2");
  EXPECT_EQ(drawn.variable, "time");
  EXPECT_FALSE(drawn.at.empty());
  left.counted.setConstant(false);
  EXPECT_TRUE(unnamed(robot, log, left, varies).at.empty());
}

/// A column that is logged once a second has its last value in between.
TEST(Unexplained, FollowsColumnsThatAreLoggedRarely) {
  const Robot robot = arm();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(20.0, 60.0);
  std::vector<Sample> samples = record({{}, 60.0}).samples();
  double temperature = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool logged = i % 100 == 50;
    if (logged) temperature = any(random);
    samples[i].extra = {logged ? temperature : std::numeric_limits<double>::quiet_NaN()};
    samples[i].tau[2] += 0.01 * temperature;
  }
  const Recording log(std::move(samples), 100.0, {"temp"});
  const RichModel model{stacked_parameters(robot), {}};
  const Series left = series(robot, ContactTreatment::ignore, model, log, 2);
  const std::vector<Structure> found = unexplained(robot, log, left, 2);
  EXPECT_TRUE(std::any_of(found.begin(), found.end(), [](const Structure& s) {
    return s.variable == "temp" && s.joint == "joint3" && s.share > 0.9;
  }));
}

TEST(Reach, IsWhereAnEffectChangesTorque) {
  const Robot robot = arm();
  EXPECT_EQ(reach_of(robot, effect("viscous_friction", 1, {0.1})), (Joints{false, true, false}));
  EXPECT_EQ(reach_of(robot, effect("torque_gain", 2, {0.1})), (Joints{false, false, true}));
  EXPECT_EQ(reach_of(robot, effect("rotor_reaction", 1, {0.1})), (Joints{true, true, false}));
  EXPECT_EQ(reach_of(robot, effect("drag", 2, {1.0})), (Joints{true, true, false}));
  EXPECT_EQ(reach_of(robot, effect("encoder_offset", 0, {0.1})), (Joints{true, true, true}));
  EXPECT_EQ(reach_of(robot, effect("torque_delay", 0, {0.01})), (Joints{true, true, true}));
}

}  // namespace
}  // namespace shapeid::diagnosis
