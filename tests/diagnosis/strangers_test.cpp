// Laws without a name: seen where no entry of the catalogue explains a joint, not seen where one
// does, and stronger than a name that only resembles them.
#include "shapeid/diagnosis/strangers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/consistent.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/unexplained.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::loop_of;
using test::record;

std::string followed(const Stranger& s) { return variable_of({s.law.signal, s.law.joint}, arm()); }

TEST(Strangers, AreNotSeenInCleanLogs) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    EXPECT_TRUE(loop_of(record({{}, 20.0, 0.02, seed})).strangers.empty()) << "seed " << seed;
  }
}

TEST(Strangers, LeaveATrueNameAlone) {
  const LoopResult result = loop_of(
      record({{effect("viscous_friction", 1, {0.3}), effect("coulomb_friction", 1, {0.4})}}));
  ASSERT_EQ(result.found.size(), 2U);
  for (const Found& f : result.found) EXPECT_TRUE(f.name_stands()) << f.id;
  EXPECT_TRUE(result.strangers.empty());
}

/// A gear that loses on one side of the load only.
TEST(Strangers, SeeAGainOnOneSide) {
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[1] *= s.tau[1] > 0.0 ? 1.04 : 1.0;
  });
  const LoopResult result = loop_of(log);
  for (const Found& f : result.found) EXPECT_FALSE(f.name_stands()) << f.id;
  ASSERT_FALSE(result.strangers.empty());
  EXPECT_EQ(followed(result.strangers.front()), "tau.joint2");

  // The gain's number is a step from nothing to 0.04, or, beside masses, from -0.02 to 0.02.
  const Structure curve =
      lawless(arm(), ContactTreatment::ignore, result.model, log, 2, result.strangers.front());
  EXPECT_EQ(curve.joint, "joint2");
  EXPECT_EQ(curve.variable, "tau.joint2");
  EXPECT_FALSE(curve.law.empty());
  EXPECT_EQ(curve.law_unit, result.strangers.front().carrier.effect->parameters.front().unit);
  ASSERT_GT(curve.at.size(), 2U);
  EXPECT_LT(curve.at.front(), curve.at.back());
  EXPECT_GT(curve.share, 0.0);
}

/// Friction that has to wind up after each turn is no viscous friction.
TEST(Strangers, SeeHysteresis) {
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    constexpr double way = 0.2, size = 0.15;
    double share = 0.0, before = samples.front().q[0];
    for (Sample& s : samples) {
      const double step = s.q[0] - before;
      before = s.q[0];
      share += (step - std::abs(step) * share) / way;
      s.tau[0] += size * share;
    }
  });
  const LoopResult result = loop_of(log);
  for (const Found& f : result.found) EXPECT_FALSE(f.name_stands()) << f.id;
  ASSERT_FALSE(result.strangers.empty());
  EXPECT_EQ(followed(result.strangers.front()), "turn.joint1");
}

TEST(Strangers, AreLawsOfDrivesTimesSignals) {
  const std::vector<AppliedEffect> own = {effect("viscous_friction", 0, {0.1})};
  const std::vector<AppliedEffect> list = carriers(arm(), own);
  ASSERT_FALSE(list.empty());
  for (const AppliedEffect& a : list) {
    EXPECT_EQ(a.effect->site, SiteKind::joint);
    EXPECT_FALSE(a.effect->built_in) << a.effect->id;
    EXPECT_FALSE(same_place(a, own[0])) << "it is in the tally already";
  }
  const auto products = modulated_carriers(record({}), list, 1, 3);
  EXPECT_EQ(products.size(), 2U * (joint_signals.size() + 1U));
  for (const Modulation& m : products) EXPECT_EQ(m.joint, list[m.hypothesis].site);
}

/// From rest: after a tenth of the range 1 - 1/e of the way is done, and it turns with the joint.
TEST(Turned, FollowsTheWaySinceTheJointTurnedRound) {
  std::vector<Sample> samples(201);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = 0.01 * static_cast<double>(i);
    const double back_and_forth =
        i <= 100 ? static_cast<double>(i) : 200.0 - static_cast<double>(i);
    samples[i].q = Eigen::VectorXd::Constant(1, 0.01 * back_and_forth);
    samples[i].dq = samples[i].ddq = samples[i].tau = Eigen::VectorXd::Zero(1);
  }
  const Recording log(std::move(samples), 100.0);
  const double once = 1.0 - std::exp(-1.0), whole = 1.0 - std::exp(-10.0);
  EXPECT_NEAR(log.turned(10, 0), once, 1e-12);
  EXPECT_NEAR(log.turned(100, 0), whole, 1e-12);
  EXPECT_NEAR(log.turned(110, 0), (1.0 + whole) * std::exp(-1.0) - 1.0, 1e-12);
}

TEST(Turned, OfAJointThatStandsStillIsNothing) {
  std::vector<Sample> samples(50);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = 0.01 * static_cast<double>(i);
    samples[i].q = samples[i].dq = samples[i].ddq = samples[i].tau = Eigen::VectorXd::Ones(1);
  }
  const Recording log(std::move(samples), 100.0);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(log.turned(i, 0), 0.0);
}

/// A change since a reference log is no length of a link: what a robot is built of stays.
TEST(Candidates, WhatIsBuiltInDoesNotComeSinceAReferenceLog) {
  const LoopResult result =
      close_loop(arm(), record({{effect("link_length", 1, {0.02})}}), nullptr, arm_settings());
  for (const Found& f : result.found) EXPECT_EQ(f.effect.when, When::always);
  const Recording later = record({{effect("link_length", 1, {0.02})}, 20.0, 0.02, 2});
  const Recording earlier = record({{}, 20.0, 0.02, 1});
  for (const Found& f : close_loop(arm(), later, &earlier, arm_settings()).found) {
    EXPECT_TRUE(f.effect.when == When::always || !f.effect.effect->built_in) << f.id;
  }
}

/// A number that is zero within its error once the links are bodies gives no name.
TEST(Consistent, WhatFadesIsNoName) {
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}});
  const LoopSettings settings = arm_settings();
  LoopResult loop = close_loop(arm(), log, nullptr, settings);
  ASSERT_EQ(loop.found.size(), 1U);
  Consistent consistent = make_consistent(arm(), log, nullptr, settings, loop);
  mark_faded(log, settings, consistent, loop);
  EXPECT_TRUE(loop.found[0].name_stands());
  consistent.effect_error[0][0] = std::abs(consistent.model.effects[0].value[0]);
  mark_faded(log, settings, consistent, loop);
  EXPECT_TRUE(loop.found[0].faded);
  EXPECT_FALSE(loop.found[0].name_stands());
}

}  // namespace
}  // namespace shapeid::diagnosis
