// What is held out is used for nothing else: torque that is spoilt there changes no mass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/inputs.hpp"
#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

constexpr double spoilt_by = 50.0;  // N m

/// The log with more torque of a knee from one time to another.
void spoil(const std::string& from, const std::string& to, double begin, double end) {
  write_changed(from, to, [&](NamedRow& row) {
    if (row["time"] >= begin && row["time"] < end) row["tau.FR_knee"] += spoilt_by;
  });
}

nlohmann::json identified_with(const std::string& arguments) {
  // Torque as logged (--exact): a filter would carry it out of the stretch.
  const CommandRun run = shapeid(fmt::format(
      "identify {} --shapes box.yaml --exact --divisions 3 --json {}", quadruped_files, arguments));
  EXPECT_EQ(run.status, 0) << run.err;
  return run.status == 0 ? nlohmann::json::parse(run.out) : nlohmann::json();
}

TEST(HoldOut, IsUsedForNothingElse) {
  simulated_log("clean.csv", "--exact --seconds 10 --rate 100");
  scratch_file("box.yaml", "base: [{kind: cuboid, size: [0.5, 0.25, 0.15]}]\n");
  for (int stretch = 1; stretch <= 5; ++stretch) {
    constexpr double length = 2.0, margin = 0.09;
    spoil("clean.csv", "spoilt.csv", length * (stretch - 1) - margin, length * stretch + margin);
    const std::string chosen = fmt::format("--hold-out {}", stretch);
    const auto clean = identified_with("--log clean.csv " + chosen);
    const auto spoilt = identified_with("--log spoilt.csv " + chosen);
    EXPECT_EQ(clean["links"], spoilt["links"]) << stretch;
    const auto wrong =
        identified_with(fmt::format("--log spoilt.csv --hold-out {}", stretch % 5 + 1));
    EXPECT_NE(clean["links"], wrong["links"]) << stretch;
    double largest = 0.0;
    for (const auto& rms : spoilt["heldout"]["rms_after"])
      largest = std::max(largest, rms.get<double>());
    EXPECT_GT(largest, 0.5 * spoilt_by) << "the test stretch is what was spoilt";
    if (stretch < 5) continue;
    EXPECT_EQ(clean["links"], identified_with("--log clean.csv")["links"])
        << "the last, if none is said";
  }
}

TEST(HoldOut, RefusesWhatIsNoStretch) {
  for (const char* wrong : {"--hold-out 0", "--hold-out 6", "--hold-out 1.5", "--hold-out two",
                            "--hold-out 2 --test other.csv"}) {
    for (const char* verb : {"identify", "diagnose"}) {
      const CommandRun run =
          shapeid(fmt::format("{} {} --log clean.csv {}", verb, quadruped_files, wrong));
      EXPECT_EQ(run.status, 2) << verb << " " << wrong;
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
      EXPECT_NE(run.err.find("hold-out"), std::string::npos) << run.err;
    }
  }
}

/// Samples of neither part lie between them, as many as the filter smears over.
TEST(HoldOut, IsAsFarFromWhatIsFittedAsTheFilterReaches) {
  const auto nothing_within = [](double cutoff, double row_cutoff) {
    app::MotionInputs inputs;
    inputs.cutoff = cutoff;
    inputs.row_cutoff = row_cutoff;
    inputs.held_out_stretch = 2;
    double reach = 0.0;
    while (app::part_of(2.0 + reach, inputs) == app::Part::neither) reach += 1e-3;
    EXPECT_EQ(app::part_of(2.0 + reach + 1e-3, inputs), app::Part::held_out);
    EXPECT_EQ(app::part_of(2.0 - reach - 2e-3, inputs), app::Part::fitted);
    EXPECT_EQ(app::part_of(4.0 + reach + 2e-3, inputs), app::Part::fitted);
    EXPECT_EQ(app::part_of(1.999 + 2e-3 - reach, inputs), app::Part::neither);
    return reach;
  };
  constexpr double step = 2e-3;
  EXPECT_NEAR(nothing_within(20.0, 0.0), 0.1, step);
  EXPECT_NEAR(nothing_within(0.0, 0.0), 0.1, step);
  EXPECT_NEAR(nothing_within(100.0, 0.0), 0.1, step);
  EXPECT_NEAR(nothing_within(5.0, 0.0), 0.4, step);
  EXPECT_NEAR(nothing_within(20.0, 4.0), 0.5, step);
  EXPECT_NEAR(nothing_within(0.5, 0.0), 0.8, step);
}

}  // namespace
}  // namespace shapeid::test
