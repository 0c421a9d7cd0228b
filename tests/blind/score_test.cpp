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
