// Which trials are drawn, and that their files tell the diagnosis nothing but what was measured.
#include "shapeid/tests/blind/parts/plan.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "shapeid/tests/blind/parts/yardstick.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::blind {
namespace {

/// Arms of one seed with eight times the detectable size of one kind, in a folder of its own.
class DrawnArms {
 public:
  explicit DrawnArms(const std::string& only, int trials) {
    PlanOptions options;
    options.seed = 2;
    options.trials = trials;
    options.quadruped_every = 0;
    options.only = only;
    options.ratio = 8.0;
    generate(options, scratch_.path("set"));
  }

  [[nodiscard]] std::string file(int number, const std::string& name) const {
    return scratch_.path(fmt::format("set/trial{:04d}/{}", number, name));
  }
  [[nodiscard]] nlohmann::json seal(int number) const {
    std::ifstream in(file(number, "sealed.json"));
    return nlohmann::json::parse(in);
  }
  [[nodiscard]] bool has_reference(int number) const {
    return std::filesystem::exists(file(number, "reference.csv"));
  }

 private:
  test::ScratchFolder scratch_;
};

/// One that answers wrongly can be had again without all before it.
TEST(Plan, ATrialByItselfIsTheSame) {
  const test::ScratchFolder scratch;
  PlanOptions options;
  options.seed = 7;
  options.trials = 2;
  options.quadruped_every = 0;
  options.drawn_arms = true;
  generate(options, scratch.path("both"));
  options.first = 1;
  options.trials = 1;
  generate(options, scratch.path("second"));
  EXPECT_FALSE(std::filesystem::exists(scratch.path("second/trial0000")));
  const auto text = [&](const std::string& set, const std::string& name) {
    std::ifstream in(scratch.path(set + "/trial0001/" + name));
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  for (const char* name : {"sealed.json", "given.urdf", "log.csv", "test.csv"}) {
    EXPECT_FALSE(text("both", name).empty()) << name;
    EXPECT_EQ(text("both", name), text("second", name)) << name;
  }
}

/// Kinds are drawn as in the mix of all: by one seed several of them.
TEST(Plan, ForeignAloneAreOfEveryKindThatIsNotInTheCatalogue) {
  constexpr int trials = 6;
  const DrawnArms arms("foreign", trials);
  std::set<std::string> kinds;
  for (int number = 0; number < trials; ++number) {
    const Trial trial = trial_from_json(arms.seal(number));
    ASSERT_EQ(trial.items.size(), 1U);
    EXPECT_TRUE(kind(trial.items[0].kind).foreign) << trial.items[0].kind;
    kinds.insert(trial.items[0].kind);
  }
  EXPECT_GT(kinds.size(), 2U);
}

TEST(Plan, AThirdHaveAReferenceThatTheyDoNotNeed) {
  int spare = 0;
  constexpr int seeds = 3000;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) spare += has_spare_reference(seed) ? 1 : 0;
  // Four deviations of so many draws to each side.
  EXPECT_NEAR(static_cast<double>(spare) / seeds, 1.0 / 3.0, 0.035);
}

/// A file that only trials with a load had would tell that there is one. Of this seed the second
/// trial is drawn to have a reference and the first is not, whatever is in them.
TEST(Plan, AReferenceTellsNothingOfWhatIsInATrial) {
  const DrawnArms clean("clean", 2), offset("torque_offset", 2), load("payload", 1);
  for (const DrawnArms* arms : {&clean, &offset}) {
    EXPECT_FALSE(arms->has_reference(0));
    EXPECT_TRUE(arms->has_reference(1));
    for (const int number : {0, 1}) {
      EXPECT_EQ(arms->seal(number).at("reference").get<bool>(), arms->has_reference(number));
      EXPECT_FALSE(arms->seal(number).at("reference_needed").get<bool>());
    }
  }
  EXPECT_TRUE(load.has_reference(0));
  EXPECT_TRUE(load.seal(0).at("reference_needed").get<bool>());

  // What is no load acts in the reference as well: of the same noise the logs differ by it alone.
  const Machine m = arm();
  const Item put = trial_from_json(offset.seal(1)).items.at(0);
  const diagnosis::Recording without = read_log(m, clean.file(1, "reference.csv"));
  const diagnosis::Recording with = read_log(m, offset.file(1, "reference.csv"));
  const auto mean = [&](const diagnosis::Recording& log) {
    double sum = 0.0;
    for (const Sample& s : log.samples()) sum += s.tau[put.amount.site];
    return sum / static_cast<double>(log.samples().size());
  };
  EXPECT_NEAR(mean(with) - mean(without), put.amount.size, 0.01 * put.amount.size);
  // And it is another recording than the log, not a copy.
  EXPECT_NE(mean(with), mean(read_log(m, offset.file(1, "log.csv"))));
}

/// What is in a trial of changes is in one of its two logs; by so many seeds both came and went.
TEST(Plan, ChangesAreInOneOfTwoLogs) {
  PlanOptions options;
  options.seed = 3;
  options.trials = 4;
  options.quadruped_every = 0;
  options.only = "torque_offset";
  options.ratio = 8.0;
  options.changes = true;
  const test::ScratchFolder scratch;
  const Machine m = arm();
  std::set<Acts> seen;
  generate(options, scratch.path("set"), [&](int number, const Trial& trial) {
    EXPECT_TRUE(trial.reference);
    EXPECT_EQ(trial_from_json(to_json(trial)).acts, trial.acts);
    seen.insert(trial.acts);
    const auto mean = [&](const std::string& name) {
      const diagnosis::Recording log =
          read_log(m, scratch.path(fmt::format("set/trial{:04d}/{}", number, name)));
      double sum = 0.0;
      for (const Sample& s : log.samples()) sum += s.tau[trial.items.at(0).amount.site];
      return sum / static_cast<double>(log.samples().size());
    };
    const double size = trial.items.at(0).amount.size;
    const double put = trial.acts == Acts::in_log ? size : -size;
    EXPECT_NEAR(mean("log.csv") - mean("reference.csv"), put, 0.1 * size) << "of two noises";
    EXPECT_EQ(items_in_log(trial).empty(), trial.acts == Acts::in_reference);
    EXPECT_EQ(items_in_reference(trial).empty(), trial.acts == Acts::in_log);
  });
  EXPECT_EQ(seen, (std::set<Acts>{Acts::in_log, Acts::in_reference}));
}

TEST(Plan, ASealSaysWhetherThereIsAReference) {
  Trial t;
  t.machine = "arm";
  EXPECT_FALSE(trial_from_json(to_json(t)).reference);
  t.reference = true;
  EXPECT_TRUE(trial_from_json(to_json(t)).reference);
  // Seals of before say nothing: there was a reference where a load needed one.
  nlohmann::json old = to_json(t);
  old.erase("reference");
  EXPECT_FALSE(trial_from_json(old).reference);
  t.items = {{"payload", {3, 1.0, {1.0, 0.0, 0.0}}, 2.0}};
  old = to_json(t);
  old.erase("reference");
  EXPECT_TRUE(trial_from_json(old).reference);
}

TEST(Plan, LoadsWereNotThereBefore) {
  const Item load{"payload", {3, 1.0, {1.0, 0.0, 0.0}}, 2.0};
  const Item later{"payload_from", {4, 1.0, {1.0, 0.0, 0.0}}, 2.0};
  const Item drag{"drag", {4, 1.0, {1.0, 0.0, 0.0}}, 2.0};
  const std::vector<Item> before = without_loads({load, drag, later});
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(before[0].kind, "drag");
}

TEST(Plan, NoKindTwiceAndNoTwoLoads) {
  EXPECT_FALSE(fit_together(kind("payload"), kind("payload_from")));
  EXPECT_FALSE(fit_together(kind("payload_from"), kind("payload")));
  EXPECT_FALSE(fit_together(kind("drag"), kind("drag")));
  EXPECT_TRUE(fit_together(kind("payload"), kind("drag")));
  const Machine m = arm();
  const Amount some_kilogram{3, 0.5, {1.0, 0.0, 0.0}};
  Ingredients in;
  kind("payload").put(in, m, some_kilogram);
  EXPECT_THROW(kind("payload_from").put(in, m, some_kilogram), std::logic_error);
}

}  // namespace
}  // namespace shapeid::blind
