// The scorer judged by answers whose worth is known.
#include "shapeid/tests/blind/parts/score.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace shapeid::blind {
namespace {

using nlohmann::json;

Item item(const std::string& id, int site) { return {id, {site, 1.0, {1.0, 0.0, 0.0}}, 2.0}; }

Trial trial(std::vector<Item> items) {
  Trial t;
  t.machine = "arm";
  t.items = std::move(items);
  return t;
}

json finding(const std::string& effect, const std::string& site,
             const std::vector<std::string>& set = {}) {
  return {{"effect", effect}, {"site", site}, {"ambiguous_with", set}};
}

json answer(const std::vector<json>& findings, bool structure = false) {
  json unexplained = json::array();
  if (structure) unexplained.push_back({{"joint", "lift"}, {"variable", "q.lift"}});
  return {{"findings", findings}, {"unexplained", unexplained}, {"links", json::array()}};
}

Outcome outcome(const Trial& t, const json& said) { return judge(t, said).outcome; }

TEST(Score, CleanLogs) {
  EXPECT_EQ(outcome(trial({}), answer({})), Outcome::right);
  EXPECT_EQ(outcome(trial({}), answer({finding("drag", "hand")})), Outcome::wrong);
}

/// A diagnosis that always says the same is right where that is so, describes what it is a part of,
/// and is wrong elsewhere.
TEST(Score, AlwaysTheSameAnswer) {
  const json always = answer({finding("viscous_friction", "lift")});
  EXPECT_EQ(outcome(trial({item("viscous_friction", 1)}), always), Outcome::right);
  EXPECT_EQ(outcome(trial({item("viscous_friction", 2)}), always), Outcome::wrong_place);
  int wrong = 0;
  for (const Kind& k : kinds()) {
    if (k.id == "viscous_friction" || !k.arm) continue;
    const bool is_part =
        std::count(k.described_by.begin(), k.described_by.end(), "viscous_friction") > 0;
    const Outcome expected = is_part ? Outcome::described : Outcome::wrong;
    EXPECT_EQ(outcome(trial({item(k.id, 1)}), always), expected) << k.id;
    if (!is_part) ++wrong;
  }
  EXPECT_GT(wrong, 20);
}

TEST(Score, NamesWithinTheSet) {
  const Trial t = trial({item("torque_offset", 0)});
  EXPECT_EQ(outcome(t, answer({finding("joint_spring", "turn", {"torque_offset@turn"})})),
            Outcome::ambiguous);
  EXPECT_EQ(outcome(t, answer({finding("joint_spring", "turn", {"torque_offset@lift"})})),
            Outcome::wrong);
}

/// Of one cause two names may be said, each with the cause among what it cannot be told from.
TEST(Score, OneCauseWithinTwoSets) {
  const Trial t = trial({item("payload", 3)});
  const std::string load = "payload@fore";
  const json first = finding("torque_gain", "bend", {load});
  EXPECT_EQ(outcome(t, answer({first, finding("torque_gain", "lift", {load})})),
            Outcome::ambiguous);
  EXPECT_EQ(outcome(t, answer({first, finding("torque_gain", "lift")})), Outcome::wrong);
}

TEST(Score, OneOfTwoAndMoreThanThereIs) {
  const Trial two = trial({item("torque_offset", 0), item("cogging", 3)});
  const json first = finding("torque_offset", "turn"), second = finding("cogging", "twist");
  EXPECT_EQ(outcome(two, answer({first, second})), Outcome::right);
  EXPECT_EQ(outcome(two, answer({first})), Outcome::partly);
  const Judgement more = judge(two, answer({first, second, finding("drag", "hand")}));
  EXPECT_EQ(more.outcome, Outcome::wrong);
  EXPECT_TRUE(more.beside);
  const Judgement less = judge(two, answer({first, finding("drag", "hand")}));
  EXPECT_EQ(less.outcome, Outcome::wrong);
  EXPECT_FALSE(less.beside);
  // One name cannot stand for two things.
  const json wide = finding("drag", "hand", {"torque_offset@turn", "cogging@twist"});
  EXPECT_EQ(outcome(two, answer({wide})), Outcome::partly);
}

/// Whichever of two effects comes first in the seal.
Outcome outcome_in_both_orders(const Item& one, const Item& other, const json& said) {
  const Outcome first = outcome(trial({one, other}), said);
  EXPECT_EQ(name_of(first), name_of(outcome(trial({other, one}), said)));
  return first;
}

TEST(Score, ANameStandsForOneEffectInWhicheverOrder) {
  const Item offset = item("torque_offset", 0), ripple = item("cogging", 3);
  const json both = finding("cogging", "twist", {"torque_offset@turn"});
  EXPECT_EQ(outcome_in_both_orders(offset, ripple, answer({both})), Outcome::partly);
  // The set that holds both is left to the one that is in no other.
  const json wide = finding("drag", "hand", {"torque_offset@turn", "cogging@twist"});
  const json narrow = finding("drag", "fore", {"torque_offset@turn"});
  for (const auto& said : {answer({wide, narrow}), answer({narrow, wide})}) {
    EXPECT_EQ(outcome_in_both_orders(offset, ripple, said), Outcome::ambiguous);
  }
}

/// A true name does not make what is said besides true, though that has it in its set.
TEST(Score, RightIsNothingElse) {
  const Trial t = trial({item("torque_offset", 0)});
  const json exact = finding("torque_offset", "turn");
  const json more = finding("joint_spring", "turn", {"torque_offset@turn"});
  EXPECT_EQ(outcome(t, answer({exact})), Outcome::right);
  EXPECT_EQ(outcome(t, answer({exact, more})), Outcome::ambiguous);
  EXPECT_EQ(outcome(t, answer({more, exact})), Outcome::ambiguous);
}

/// Only of what is wrong is it said that it stands beside all that was there.
TEST(Score, BesideIsOfTheWrong) {
  const Trial t = trial({item("torque_offset", 0)});
  const json exact = finding("torque_offset", "turn");
  EXPECT_FALSE(judge(t, answer({exact})).beside);
  EXPECT_FALSE(judge(t, answer({finding("drag", "hand", {"torque_offset@turn"})})).beside);
  EXPECT_TRUE(judge(t, answer({exact, finding("torque_offset", "lift")})).beside);
  EXPECT_FALSE(judge(t, answer({finding("torque_offset", "lift")})).beside);
}

Scored scored_as(const Trial& t, const json& said) { return {t, judge(t, said)}; }

/// Whether the tables have a row that begins so.
bool has_row(const std::vector<Scored>& all, const std::string& begin) {
  return tables(all).find("\n| " + begin) != std::string::npos;
}

TEST(ScoreTables, SetsOfTheAmbiguousAreShown) {
  const Trial t = trial({item("torque_offset", 0)});
  std::vector<Scored> all;
  for (const std::size_t others : {0U, 2U, 40U}) {
    std::vector<std::string> set(others, "cogging@lift");
    set.emplace_back("torque_offset@turn");
    all.push_back(scored_as(t, answer({finding("joint_spring", "turn", set)})));
  }
  // Of what is right the set is not asked.
  all.push_back(scored_as(
      t, answer({finding("torque_offset", "turn", std::vector<std::string>(99, "cogging@lift"))})));
  EXPECT_TRUE(has_row(all, "effects of the catalogue | 3 | 3 | 41 |")) << tables(all);
  EXPECT_TRUE(has_row(all, "of these at twice the detectable size and above | 3 | 3 | 41 |"));
  EXPECT_TRUE(has_row(all, "foreign effects | 0 | - | - |"));
}

TEST(ScoreTables, ACrashIsAnOutcomeOfItsOwn) {
  const Trial t = trial({item("torque_offset", 0)});
  Scored crash{t, {}};
  crash.judgement.outcome = Outcome::crashed;
  const std::vector<Scored> all = {crash, scored_as(t, answer({finding("torque_offset", "turn")}))};
  EXPECT_TRUE(has_row(all, "the diagnosis crashed | 1 of 2 |")) << tables(all);
  // It counts among what should have been right.
  EXPECT_TRUE(has_row(
      all, "right or honestly ambiguous, at twice the detectable size and above | 1 of 2 |"));
  EXPECT_NE(tables(all).find("| crashed |"), std::string::npos);
}

TEST(ScoreTables, WhereAForeignEffectIsReportedIsCounted) {
  // What is unexplained is so at lift.
  const std::vector<Scored> all = {
      scored_as(trial({item("backlash", 1)}), answer({}, true)),
      scored_as(trial({item("backlash", 2)}), answer({}, true)),
      scored_as(trial({item("warm_offset", 2)}), answer({finding("torque_offset", "bend")}, true)),
      scored_as(trial({item("backlash", 1)}), answer({}))};
  EXPECT_TRUE(
      has_row(all,
              "foreign effects unexplained or rightly described, at twice the detectable size | "
              "3 of 4 |"))
      << tables(all);
  EXPECT_TRUE(has_row(
      all, "of these with a name or something unexplained at the effect's own joint | 2 of 3 |"));
  // An effect of no joint can be reported at any.
  Trial feet = trial({item("soft_ground", 0)});
  feet.machine = "quadruped";
  EXPECT_TRUE(judge(feet, answer({}, true)).at_its_place);
  EXPECT_FALSE(judge(feet, answer({})).at_its_place);
}

TEST(ScoreTables, NothingIsNotAtTwiceASize) {
  const std::string text = tables({scored_as(trial({}), answer({}))});
  const auto from = text.find("By effect, at twice");
  const std::string by_effect = text.substr(from, text.find("Effects that are not", from) - from);
  EXPECT_EQ(by_effect.find("| clean |"), std::string::npos) << by_effect;
}

/// A reference log tempts to name a load, and to say of what was there before that it came since.
TEST(ScoreTables, ReferencesThatWereNotNeededAreCounted) {
  Trial clean = trial({}), offset = trial({item("torque_offset", 0)});
  Trial load = trial({item("payload", 3)});
  const Trial alone = clean;
  clean.reference = offset.reference = load.reference = true;
  json since = finding("torque_offset", "turn");
  since["since_reference"] = true;
  json undecided = since;
  undecided["may_act_in_both"] = true;
  json carried = finding("payload", "fore");
  carried["since_reference"] = true;
  const std::vector<Scored> all = {
      scored_as(clean, answer({carried})), scored_as(offset, answer({since})),
      scored_as(load, answer({carried})), scored_as(alone, answer({carried})),
      scored_as(offset, answer({undecided}))};
  EXPECT_TRUE(has_row(all, "trials without a static load that had a reference log | 3 of 4 |"))
      << tables(all);
  EXPECT_TRUE(has_row(
      all, "of these a load named where there is none, be it as one of several names | 1 of 3 |"));
  EXPECT_TRUE(
      has_row(all, "an effect said to have come since a reference log that has it too | 1 of 2 |"));
}

/// What nothing says is gone must not be said to be; where something went it may be, and its time
/// is counted apart from its name.
TEST(Score, WhatWentIsNamedWithItsTime) {
  Trial both = trial({item("torque_offset", 0)});
  both.reference = true;
  json gone = finding("torque_offset", "turn");
  gone["gone_since_reference"] = true;
  json undecided = gone;
  undecided["may_act_in_both"] = true;
  EXPECT_EQ(judge(both, answer({gone})).outcome, Outcome::wrong_place);
  EXPECT_EQ(judge(both, answer({undecided})).outcome, Outcome::right);
  json came = finding("torque_offset", "turn");
  came["since_reference"] = true;
  const json always = finding("torque_offset", "turn");
  json may_have_come = always;
  may_have_come["may_have_come_since"] = true;
  const auto is_false_time = [&](Acts acts, const json& said) {
    Trial t = both;
    t.acts = acts;
    const Judgement j = judge(t, answer({said}));
    EXPECT_EQ(j.outcome, Outcome::right);
    return j.false_time;
  };
  EXPECT_FALSE(is_false_time(Acts::in_reference, gone));
  EXPECT_TRUE(is_false_time(Acts::in_reference, came));
  EXPECT_TRUE(is_false_time(Acts::in_reference, always));
  EXPECT_FALSE(is_false_time(Acts::in_log, came));
  EXPECT_FALSE(is_false_time(Acts::in_log, may_have_come));
  EXPECT_TRUE(is_false_time(Acts::in_log, always));
  Trial went = both;
  went.acts = Acts::in_reference;
  EXPECT_TRUE(has_row({scored_as(went, answer({gone})), scored_as(went, answer({always}))},
                      "an effect that came since the reference log or went said to act otherwise | "
                      "1 of 2 |"));
}

/// A load on the wrong link needed no reference; one that was never absent did.
TEST(Score, AFalseLoadIsOneOfAKindThatIsNotThere) {
  const Trial later = trial({item("payload_from", 3)});
  EXPECT_FALSE(judge(later, answer({finding("payload_from", "fore")})).false_load);
  EXPECT_FALSE(judge(later, answer({finding("payload_from", "hand")})).false_load);
  EXPECT_TRUE(judge(later, answer({finding("payload", "fore")})).false_load);
  EXPECT_TRUE(judge(trial({item("drag", 3)}), answer({finding("payload", "fore", {"drag@fore"})}))
                  .false_load);
}

TEST(Score, NothingSaid) {
  const Trial t = trial({item("torque_offset", 0)});
  EXPECT_EQ(outcome(t, answer({})), Outcome::abstained);
  EXPECT_EQ(outcome(t, answer({}, true)), Outcome::unexplained);
  EXPECT_EQ(outcome(t, json()), Outcome::refused);
}

TEST(Score, ForeignEffects) {
  const Trial warm = trial({item("warm_offset", 1)});
  EXPECT_EQ(outcome(warm, answer({finding("torque_offset", "lift")})), Outcome::described);
  EXPECT_EQ(outcome(warm, answer({finding("torque_offset", "turn")})), Outcome::wrong);
  EXPECT_EQ(outcome(warm, answer({}, true)), Outcome::unexplained);
  const Trial foreign = trial({item("backlash", 1)});
  json said = finding("torque_offset", "lift");
  EXPECT_EQ(outcome(foreign, answer({said})), Outcome::wrong);
  // A law without a name is said to do as well: that is honest of what has no name, and no excuse
  // for a wrong name of what has one.
  said["or_without_name"] = "gear@lift with play";
  EXPECT_EQ(outcome(foreign, answer({said})), Outcome::ambiguous);
  EXPECT_EQ(outcome(foreign, answer({said, finding("drag", "hand")})), Outcome::wrong);
  EXPECT_EQ(outcome(trial({item("cogging", 1)}), answer({said})), Outcome::wrong);
}

TEST(Score, InertiasAreComparedWithTheTruth) {
  const Machine m = arm();
  const Vector10 truth = m.robot.links[2].inertia.values;
  const auto numbers = [](const Vector10& v) { return std::vector<double>(v.begin(), v.end()); };
  json said = answer({});
  std::vector<bool> only_mass(10, false);
  only_mass[0] = true;
  Vector10 given = 1.5 * truth;
  given[0] = 1.2 * truth[0];
  said["links"].push_back({{"name", "upper"},
                           {"given", numbers(given)},
                           {"parameters", numbers(1.1 * truth)},
                           {"standard_error", numbers(0.04 * truth)},
                           {"error_if_unnoticed", numbers(0.05 * truth)},
                           {"determined", only_mass}});
  const Judgement j = judge(trial({}), said);
  EXPECT_GT(j.given.all, 4.0 * j.found.all * (0.2 / 0.5));
  EXPECT_GT(j.found.all, j.found.determined);
  // Of the mass alone, relative to itself.
  EXPECT_NEAR(j.given.determined, 0.2, 1e-12);
  EXPECT_NEAR(j.found.determined, 0.1, 1e-12);
  // And in units of their own.
  EXPECT_NEAR(j.given.all_by_unit[0], 0.2 * truth[0], 1e-12);
  EXPECT_NEAR(j.given.all_by_unit[1], 0.5 * truth.segment<3>(1).norm(), 1e-12);
  EXPECT_NEAR(j.found.all_by_unit[2], 0.1 * truth.tail<6>().norm(), 1e-12);
  EXPECT_NEAR(j.found.determined_by_unit[0], 0.1 * truth[0], 1e-12);
  EXPECT_EQ(j.found.determined_by_unit[1], 0.0);
  EXPECT_NEAR(j.standard_errors, 2.5, 1e-12);
  EXPECT_NEAR(j.errors_if_unnoticed, 2.0, 1e-12);
}

/// Against the closed form at its well known values (Wilson 1927; Agresti and Coull 1998).
TEST(Score, WilsonBounds) {
  EXPECT_DOUBLE_EQ(wilson(0, 10).lower, 0.0);
  EXPECT_NEAR(wilson(0, 10).upper, 0.2775, 1e-4);  // four digits are printed there
  EXPECT_NEAR(wilson(5, 10).lower, 0.2366, 1e-4);
  EXPECT_NEAR(wilson(5, 10).upper, 0.7634, 1e-4);
  EXPECT_DOUBLE_EQ(wilson(0, 0).upper, 1.0);
}

}  // namespace
}  // namespace shapeid::blind
