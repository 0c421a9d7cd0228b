// The loop as a whole, on computed logs: what is in them is found, where it is and how large, and
// nothing else.
#include "shapeid/diagnosis/loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/consistent.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/unexplained.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::ArmLog;
using test::effect;
using test::found_ids;
using test::record;
using Ids = std::vector<std::string>;

LoopResult loop_of(const ArmLog& log) { return test::loop_of(record(log)); }

/// Within five of its standard errors, which is what the error is for; one in a million by chance.
void expect_value(const Found& found, const std::vector<double>& truth) {
  constexpr double errors = 5.0;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    EXPECT_LT(std::abs(found.effect.value[at] - truth[p]), errors * found.standard_error[at])
        << found.id << " " << found.effect.value[at] << " +- " << found.standard_error[at];
  }
}

TEST(Loop, FindsNothingInCleanLogs) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const LoopResult result = loop_of({{}, 20.0, 0.02, seed});
    EXPECT_EQ(found_ids(result), Ids{}) << "seed " << seed;
    EXPECT_GT(result.hypotheses, 50U) << "of three joints and links";
    EXPECT_NEAR(result.error_end, 1.0, 0.2) << "weights are one over the variance that is left";
  }
}

struct Truth {
  std::string id, place;
  int site;
  std::vector<double> value;
};

class OneEffect : public ::testing::TestWithParam<Truth> {};

TEST_P(OneEffect, IsFoundWhereItIs) {
  const Truth& truth = GetParam();
  const LoopResult result = loop_of({{effect(truth.id, truth.site, truth.value)}});
  const std::string wanted = truth.id + "@" + truth.place;
  ASSERT_EQ(result.found.size(), 1U) << ::testing::PrintToString(found_ids(result));
  EXPECT_EQ(result.found[0].id, wanted);
  expect_value(result.found[0], truth.value);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, OneEffect,
                         ::testing::Values(Truth{"viscous_friction", "joint2", 1, {0.3}},
                                           Truth{"coulomb_friction", "joint3", 2, {0.4}},
                                           Truth{"torque_offset", "joint1", 0, {0.3}},
                                           Truth{"cogging", "joint1", 0, {0.3, 0.2}},
                                           Truth{"torque_lag", "joint2", 1, {0.01}},
                                           Truth{"torque_delay", "all", 0, {0.012}}),
                         [](const auto& one) { return one.param.id; });

/// A log without any noise, as the first that one tries comes from a simulator: what remains is
/// rounding, and nothing without a name is in it.
TEST(Loop, AnExactLogHasItsCauseAndNothingElse) {
  for (const int joint : {0, 1, 2}) {
    const Recording log = record({{effect("viscous_friction", joint, {0.4})}, 20.0, 0.0});
    const LoopResult result = test::loop_of(log);
    ASSERT_EQ(found_ids(result), Ids{"viscous_friction@joint" + std::to_string(joint + 1)});
    const Found& found = result.found[0];
    EXPECT_TRUE(found.name_stands());
    EXPECT_LE(found.gain, 1.0);
    EXPECT_NEAR(found.effect.value[0], 0.4, 1e-6);
    // The second link's origin is moved by the first joint alone: a drag of it is its friction.
    EXPECT_EQ(found.ambiguous_with, joint == 0 ? Ids{"drag@link2"} : Ids{}) << found.id;
    EXPECT_TRUE(result.strangers.empty());
    const LoopSettings settings = arm_settings();
    const Series left = series(arm(), settings.rows, result.model, log, settings.stride);
    EXPECT_TRUE(unexplained(arm(), log, left, settings.stride).empty());
  }
}

/// The prediction that a gain scales holds all laws of its joint: a gain of one, with masses that
/// make up for the rest, is each of them.
TEST(Loop, AGainIsNoNameForEveryLawOfItsJoint) {
  const LoopResult result =
      loop_of({{effect("viscous_friction", 1, {0.3}), effect("coulomb_friction", 1, {0.4}),
                effect("cogging", 1, {0.3, 0.2})},
               40.0});
  EXPECT_EQ(result.found.size(), 3U) << testing::PrintToString(found_ids(result));
  for (const Found& f : result.found) {
    EXPECT_EQ(std::ranges::count(f.ambiguous_with, "torque_gain@joint2"), 0) << f.id;
  }
}

/// What a large delay leaves of its derivative is no lag of single drives, no friction and no drag.
TEST(Loop, LargeDelayBesideALargerOffsetIsOneDelay) {
  LoopResult result =
      loop_of({{effect("torque_offset", 2, {2.0}), effect("torque_delay", 0, {0.016})}});
  std::vector<std::string> ids = found_ids(result);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (Ids{"torque_delay@all", "torque_offset@joint3"}));
}

/// Found by trying seeds: from the second round on two models take turns, each with the weights
/// that lead to the other. The one that has the lag which is there predicts better, whichever is
/// last.
TEST(Loop, RoundsThatGoInACircleEndWithTheBest) {
  const Recording log =
      record({{effect("torque_lag", 0, {0.00911}), effect("coulomb_friction", 1, {0.016}),
               effect("torque_gain", 2, {-0.0485}), effect("joint_spring", 0, {0.0138, -0.0491}),
               effect("load_friction", 0, {0.00577})},
              12.0,
              0.02,
              462});
  LoopSettings settings = arm_settings();
  for (const int rounds : {5, 6}) {
    settings.rounds = rounds;
    std::vector<std::string> ids = found_ids(close_loop(arm(), log, nullptr, settings));
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(ids, (Ids{"coulomb_friction@joint2", "joint_spring@joint1", "torque_gain@joint2",
                        "torque_lag@joint1"}))
        << rounds;
  }
}

TEST(Loop, LoadThatComesIsFoundOnItsLinkFromItsMoment) {
  AppliedEffect load =
      effect("payload_from", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  load.shape[0] = 9.0;
  const LoopResult result = loop_of({{load}, 20.0});
  ASSERT_EQ(found_ids(result), Ids{"payload_from@link3"});
  const Found& found = result.found[0];
  EXPECT_LT(std::abs(found.effect.shape[0] - 9.0), 0.5) << "a block";
  EXPECT_LT(std::abs(found.effect.value[0] - 0.8), 0.1);
}

/// At six seconds, between the moments of five and six and a half that are looked at anyway.
struct ComesBetween {
  AppliedEffect load =
      effect("payload_from", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  Recording without = record({{}, 12.0});

  [[nodiscard]] Recording with() {
    load.shape[0] = 6.0;
    return record({{load}, 12.0, 0.02, 2});
  }
};

/// Taken to be there a second too early or too late it may cost more than it gains.
TEST(Candidates, HaveTheMomentFromWhichALoadExplainsMost) {
  ComesBetween log;
  const Recording with = log.with();
  const Robot robot = arm();
  const LoopSettings settings = arm_settings();
  LoopState state(robot, with, &log.without, settings);
  const BlockFits fits = state.tallied({});
  CandidateRule rule;
  rule.free_links = settings.shapes.free_links;
  rule.has_reference = true;
  rule.excluded = [](const AppliedEffect&) { return false; };
  rule.choices = [](const AppliedEffect&) { return 1.0; };
  const std::vector<Candidate> list = candidates(robot, fits, rule);
  EXPECT_TRUE(std::any_of(list.begin(), list.end(), [](const Candidate& c) {
    return c.effect.begins() && c.effect.site == 3 && std::abs(c.effect.shape[0] - 6.0) < 0.3;
  }));
}

/// A ripple at every joint was chosen among as many periods as that of any.
TEST(Candidates, AGroupPaysForThePeriodsOfItsMembers) {
  const Robot robot = arm();
  const LoopSettings settings = arm_settings();
  const Recording log = record({});
  LoopState state(robot, log, nullptr, settings);
  const BlockFits fits = state.tallied(all_hypotheses(robot));
  CandidateRule rule;
  rule.excluded = [](const AppliedEffect&) { return false; };
  rule.choices = [](const AppliedEffect& a) { return is_ripple(a) ? 3.0 + a.site : 1.0; };
  int ripples = 0, others = 0;
  for (const Candidate& group : candidates(robot, fits, rule)) {
    if (group.members.empty()) continue;
    ++(is_ripple(group.effect) ? ripples : others);
    const double most = is_ripple(group.effect) ? 2.0 + robot.joint_count() : 1.0;
    EXPECT_EQ(group.choices, most) << group.term.id;
  }
  EXPECT_EQ(ripples, 1);
  EXPECT_GT(others, 3);
}

/// What noise of its encoder makes of gravity was called cogging, of 16 N m at a joint that asks
/// for 2.
TEST(Candidates, AJointThatStandsHasNoRipple) {
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].q[2] = 0.7 + 1e-4 * std::sin(1e3 * static_cast<double>(i));
      samples[i].dq[2] = samples[i].ddq[2] = 0.0;
    }
  });
  AppliedEffect ripple = effect("cogging", 2, {0.1, 0.1});
  ripple.shape[0] = 100.0;
  EXPECT_TRUE(is_ripple_at_rest(log, ripple));
  ripple.site = 1;
  EXPECT_FALSE(is_ripple_at_rest(log, ripple));
  EXPECT_EQ(test::loop_of(log).hypotheses + 1, test::loop_of(record({})).hypotheses);
}

/// What it found is told before names are questioned; unless that asks for other logs it is closed.
TEST(Loop, IsBrokenOffWhereItsCausesAskForOtherLogs) {
  const Recording log = record({{effect("torque_lag", 0, {0.009})}});
  for (const bool ask : {true, false}) {
    std::vector<Found> causes;
    const LoopOrCauses loop = close_loop_unless(
        [&](const std::vector<Found>& found) {
          causes = found;
          return ask;
        },
        arm(), log, nullptr, arm_settings());
    ASSERT_EQ(causes.size(), 1U);
    EXPECT_EQ(causes.front().id, "torque_lag@joint1");
    EXPECT_EQ(loop.is_closed, !ask);
    EXPECT_EQ(found_ids(loop.result), Ids{"torque_lag@joint1"});
    EXPECT_EQ(loop.result.blocks > 0, !ask) << "the models are compared at the end";
  }
}

TEST(Loop, LoadThatComesIsFoundBesideAReferenceLog) {
  ComesBetween log;
  const LoopResult result = close_loop(arm(), log.with(), &log.without, arm_settings());
  ASSERT_EQ(found_ids(result), Ids{"payload_from@link3"});
  EXPECT_LT(std::abs(result.found[0].effect.shape[0] - 6.0), 0.5) << "a block";
  EXPECT_LT(std::abs(result.found[0].effect.value[0] - 0.8), 0.1);
}

/// What begins at a moment and is no load describes that log alone: it is not a part of the model.
TEST(Loop, WhatBeginsAndIsNoLoadIsNoPartOfTheModel) {
  const Recording log = record({}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) {
      if (s.time > 9.0) s.tau[1] *= 1.3;  // a load of the last link describes it best
    }
  });
  for (const Found& f : test::loop_of(log).found) EXPECT_NE(f.id, "payload_from@link3");
}

/// Springs of two joints bring that of the third in with them, which holds its offset.
TEST(Loop, OffsetTakesThePlaceOfASpringWithoutStiffness) {
  const LoopResult result =
      loop_of({{effect("joint_spring", 0, {1.0, 0.5}), effect("joint_spring", 2, {0.8, -0.4}),
                effect("torque_offset", 1, {0.3})},
               20.0,
               0.02,
               2});
  EXPECT_EQ(found_ids(result),
            (Ids{"joint_spring@joint1", "joint_spring@joint3", "torque_offset@joint2"}));
}

TEST(Loop, StaticLoadIsFoundAgainstAReferenceLogAndNotWithout) {
  const AppliedEffect load =
      effect("payload", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  const Recording with = record({{load}, 20.0, 0.02, 2});
  const Recording without = record({{}, 20.0, 0.02, 1});
  EXPECT_EQ(found_ids(close_loop(arm(), with, nullptr, arm_settings())), Ids{});
  const LoopResult result = close_loop(arm(), with, &without, arm_settings());
  ASSERT_EQ(found_ids(result), Ids{"payload@link3"});
  EXPECT_EQ(result.found[0].effect.when, When::since_reference);
  EXPECT_LT(std::abs(result.found[0].effect.value[0] - 0.8), 0.1);
}

TEST(Loop, WhatIsToldOfTheErrorIsOfTheLogAlone) {
  const Recording tiny = record({{}, 3.0}), reference = record({{}, 20.0, 0.02, 2});
  const LoopSettings settings = arm_settings();
  EXPECT_THROW(static_cast<void>(close_loop(arm(), tiny, &reference, settings)), Refusal);
  const Recording log = record({});
  const LoopResult alone = close_loop(arm(), log, nullptr, settings);
  const LoopResult beside = close_loop(arm(), log, &reference, settings);
  EXPECT_EQ(alone.blocks, beside.blocks);
  EXPECT_EQ(alone.samples, beside.samples);
}

/// A gain that came since is applied, and changes nothing in the reference log.
TEST(Loop, AGainThatCameSinceIsFoundAsThat) {
  const Recording log = record({{effect("torque_gain", 1, {0.2})}, 20.0, 0.02, 2});
  const Recording reference = record({});
  const LoopResult result = close_loop(arm(), log, &reference, arm_settings());
  ASSERT_EQ(found_ids(result), Ids{"torque_gain@joint2"});
  EXPECT_EQ(result.found[0].effect.when, When::since_reference);
  expect_value(result.found[0], {0.2});
}

/// What changes samples is at its place once, from the beginning or since.
TEST(Loop, ADelayThatCameSinceIsFoundAsThat) {
  const Recording log = record({{effect("torque_delay", 0, {0.012})}, 20.0, 0.02, 2});
  const Recording without = record({}), with = record({{effect("torque_delay", 0, {0.012})}});
  for (const bool came : {true, false}) {
    const LoopResult result = close_loop(arm(), log, came ? &without : &with, arm_settings());
    ASSERT_EQ(found_ids(result), Ids{"torque_delay@all"});
    EXPECT_EQ(result.found[0].effect.when, came ? When::since_reference : When::always);
    EXPECT_TRUE(result.found[0].other_times.empty());
    EXPECT_NEAR(result.found[0].effect.value[0], 0.012, 0.001);
  }
}

/// What was there and grew is there twice: as it was, and what came on top.
TEST(Loop, WhatGrewSinceTheReferenceIsWhatItWasAndWhatCame) {
  const auto reference = [](const std::string& id, double value) {
    return record({{effect(id, 1, {value})}, 20.0, 0.02, 7});
  };
  const auto grown = [&](const std::string& id, double before, double after) {
    const Recording earlier = reference(id, before);
    const Recording log = record({{effect(id, 1, {after})}});
    const LoopSettings settings = arm_settings();
    const LoopResult result = close_loop(arm(), log, &earlier, settings);
    const Consistent consistent = make_consistent(arm(), log, &earlier, settings, result);
    const std::string name = id + "@joint2";
    EXPECT_EQ(found_ids(result), (Ids{name, name}));
    double was = 1.0, came = 1.0, sum = 0.0;
    for (const AppliedEffect& a : consistent.model.effects) {
      (a.when == When::since_reference ? came : was) += a.value[0];
      sum += a.value[0];
    }
    // A gain on top of a gain is their product.
    const bool scales = id == "torque_gain";
    EXPECT_NEAR(was, 1.0 + before, 0.01) << id;
    EXPECT_NEAR(scales ? was * came - 1.0 : sum, after, 0.01) << id;
  };
  grown("viscous_friction", 0.2, 0.4);
  grown("torque_gain", 0.2, 0.4);
}

/// What was in the reference log and is not in the log is no change of another sign.
TEST(Loop, WhatWentIsFoundAsThat) {
  const LoopSettings settings = arm_settings();
  const AppliedEffect load =
      effect("payload", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  const Recording log = record({{}, 20.0, 0.02, 2});
  for (const AppliedEffect& was :
       {load, effect("viscous_friction", 1, {0.3}), effect("torque_gain", 1, {0.2})}) {
    const Recording reference = record({{was}, 20.0, 0.02, 1});
    LoopResult result = close_loop(arm(), log, &reference, settings);
    ASSERT_EQ(found_ids(result), Ids{hypothesis_id(arm(), was)});
    EXPECT_EQ(result.found[0].effect.when, When::gone);
    EXPECT_TRUE(result.found[0].other_times.empty());
    const Consistent consistent = make_consistent(arm(), log, &reference, settings, result);
    ASSERT_EQ(consistent.model.effects.size(), 1U);
    EXPECT_NEAR(consistent.model.effects[0].value[0] / was.value[0], 1.0, 0.1);
    EXPECT_TRUE(consistent.model.acting().empty());
    const double given = stacked_parameters(arm())[30];
    EXPECT_NEAR(consistent.model.Phi[30], given, 0.1 * given) << "the link is as it is now";
  }
}

/// Of friction that fell a part is there still.
TEST(Loop, WhatFellIsWhatIsThereAndWhatWent) {
  const Recording log = record({{effect("viscous_friction", 1, {0.2})}});
  const Recording reference = record({{effect("viscous_friction", 1, {0.5})}, 20.0, 0.02, 7});
  const LoopResult result = close_loop(arm(), log, &reference, arm_settings());
  const std::string name = "viscous_friction@joint2";
  ASSERT_EQ(found_ids(result), (Ids{name, name}));
  for (const Found& f : result.found) {
    EXPECT_EQ(f.effect.when, f.effect.value[0] > 0.25 ? When::gone : When::always);
    EXPECT_NEAR(f.effect.value[0], f.effect.when == When::gone ? 0.3 : 0.2, 0.02);
  }
}

/// With every link known nothing but the reference log tells what was there already.
TEST(Loop, WhatIsInBothLogsDidNotComeSinceWhereMassesAreKnown) {
  LoopSettings settings = arm_settings();
  settings.shapes.free_links.clear();
  settings.shapes.shapes.clear();
  settings.shapes.known = stacked_parameters(arm());
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}});
  const Recording reference = record({{effect("viscous_friction", 1, {0.3})}, 20.0, 0.02, 7});
  const LoopResult result = close_loop(arm(), log, &reference, settings);
  ASSERT_EQ(found_ids(result), Ids{"viscous_friction@joint2"});
  EXPECT_EQ(result.found[0].effect.when, When::always);
  EXPECT_TRUE(result.found[0].other_times.empty());
}

/// Of what was not there yet the reference log knows nothing, and the log nothing of what went: it
/// would make their numbers look twice as sure.
TEST(Loop, TransformationsHaveNoColumnInALogInWhichTheyDoNotAct) {
  const Robot robot = arm();
  const Recording log = record({}), reference = record({{}, 20.0, 0.02, 2});
  const LoopSettings settings = arm_settings();
  for (const When when : every_when) {
    LoopState state(robot, log, &reference, settings);
    state.fit_masses();
    Found gain{effect("torque_gain", 1, {0.2}), "torque_gain@joint2", Eigen::VectorXd::Zero(1)};
    gain.effect.when = when;
    state.result.found.push_back(gain);
    state.collect_effects();
    const BlockFits fits = state.tallied({gain.effect});
    const Tally& tally = fits.tally();
    ASSERT_GT(fits.first_block(), 0U);
    for (const Block& block : tally.blocks) {
      const bool acts =
          block.reference ? gain.effect.acts_in_reference() : gain.effect.acts_in_log();
      EXPECT_EQ(block.sums.col(tally.first[0]).isZero(0.0), !acts);
    }
  }
}

/// Rigid links alone, beside what was found: not with the delay that was found, but without.
TEST(Loop, RigidLinksAreComparedWithoutWhatWasFound) {
  const LoopResult result = loop_of({{effect("torque_delay", 0, {0.012})}});
  ASSERT_EQ(found_ids(result), Ids{"torque_delay@all"});
  EXPECT_NEAR(result.error_end, 1.0, 0.2);
  const double without = 1.0 / (1.0 - result.found[0].gain);  // by its gain
  EXPECT_NEAR(result.error_rigid / (result.error_end * without), 1.0, 0.05);
  EXPECT_GT(result.error_given, 2.0);
}

/// The filter's own error is taken out of both logs, or would be what came since.
TEST(Loop, BothLogsAreCorrected) {
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}}), rough = record({});
  LoopSettings settings = arm_settings();
  settings.rough = settings.rough_reference = &rough;
  settings.cutoff = 10.0;
  const Robot robot = arm();
  LoopState state(robot, log, &log, settings);
  state.fit_masses();
  state.correct();
  ASSERT_EQ(state.result.correction.size(), log.samples().size());
  EXPECT_GT(state.result.correction[500].norm(), 0.0);
  EXPECT_EQ(state.result.correction, state.result.reference_correction);
  EXPECT_EQ(state.reference->correction(500), state.result.correction[500]);
}

TEST(Loop, FrictionThatIsNegativeIsNotBelieved) {
  const LoopResult result = loop_of({{effect("viscous_friction", 1, {-0.3})}});
  for (const Found& f : result.found) EXPECT_NE(f.id, "viscous_friction@joint2");
}

}  // namespace
}  // namespace shapeid::diagnosis
