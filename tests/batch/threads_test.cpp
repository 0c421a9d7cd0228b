// Many logs at once say what one log says, and the same whoever reads them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/batch/pieces.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

std::string batch(const std::string& options) {
  return fmt::format("batch {} --json {}", bundled_robot(), options);
}

json done(const std::string& arguments) {
  const CommandRun run = shapeid(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run.status == 0 ? json::parse(run.out) : json();
}

/// Ten numbers of the first link.
Eigen::VectorXd numbers(const json& result, const char* key) {
  const auto list = result.at("links").at(0).at(key).get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

Eigen::VectorXd parameters(const json& result) { return numbers(result, "parameters"); }

TEST(BatchThreads, SameBytesForAnyNumber) {
  const std::string logs = "--divisions 10 --log " + piece_names();
  const CommandRun one = shapeid(batch(logs + "--threads 1"));
  ASSERT_EQ(one.status, 0) << one.err;
  for (const int threads : {2, 4, 7, 12}) {
    const CommandRun many = shapeid(batch(fmt::format("{} --threads {}", logs, threads)));
    ASSERT_EQ(many.status, 0) << many.err;
    EXPECT_TRUE(many.out == one.out) << threads << " threads say something else";
  }
}

/// How far apart the parameters are, in roundings of their own size.
double apart(const json& a, const json& b) {
  return scaled_difference(parameters(a), parameters(b), parameters(a).size());
}

TEST(BatchThreads, AnotherOrderOfLogsMovesTheLastBitsAtMost) {
  const json forward = done(batch("--divisions 0 --log " + piece_names()));
  const json backward = done(
      batch("--divisions 0 --log piece6.csv piece5.csv piece4.csv piece3.csv piece2.csv piece1.csv "
            "piece0.csv"));
  EXPECT_LE(apart(forward, backward), few_hundred_eps);
}

TEST(BatchThreads, EqualsIdentifyOnOneLogWithGaps) {
  // The rate is said: estimated from time stamps it differs by roundings, and with it which sample
  // is a piece's last.
  const json parts = done(batch("--rate 500 --divisions 5 --log " + piece_names()));
  // All of it is fitted if something else is tested on.
  simulated_log("other.csv", "--seconds 2 --rate 500 --seed 9");
  const json whole =
      done(fmt::format("identify {0} --json --rate 500 --divisions 5 --log {1} --test other.csv",
                       bundled_robot(), whole_name()));
  EXPECT_EQ(parts.at("samples"), whole.at("samples"));
  EXPECT_LE(apart(parts, whole), few_hundred_eps);
  const double data = whole.at("objective").at("data").get<double>();
  EXPECT_LE(scaled(std::abs(parts.at("objective").at("data").get<double>() - data), data, pieces),
            few_hundred_eps);
}

/// Behind 55 Hz every row counts, so that it does not matter where a log begins to count.
TEST(BatchThreads, ASlowerFilterSaysTheSameOfOneLogWithGaps) {
  const std::string options = "--rate 500 --cutoff 110 --divisions 0 --log ";
  simulated_log("other.csv", "--seconds 2 --rate 500 --seed 9");
  const json parts = done(batch(options + piece_names())),
             whole = done(fmt::format("identify {} --json {} {} --test other.csv", bundled_robot(),
                                      options, whole_name()));
  EXPECT_EQ(parts.at("slower_cutoff"), 55.0);
  const auto behind = [](const json& result) -> Eigen::VectorXd {
    return numbers(result, "data_value") + numbers(result, "move_behind_slower_filter");
  };
  EXPECT_GT(numbers(whole, "move_behind_slower_filter").norm(), 1e-3 * behind(whole).norm());
  EXPECT_LE(scaled_difference(behind(parts), behind(whole), 10), few_hundred_eps);
}

TEST(BatchThreads, ResidualsOfTheLogsAddUpToTheObjective) {
  const json found = done(batch("--divisions 0 --log " + piece_names()));
  ASSERT_EQ(found.at("logs").size(), static_cast<std::size_t>(pieces));
  double sum = 0.0;
  std::size_t samples = 0;
  for (const json& log : found.at("logs")) {
    EXPECT_TRUE(log.at("refused").is_null());
    const double residual = log.at("residual").get<double>();
    sum += residual * residual * log.at("samples").get<double>();
    samples += log.at("samples").get<std::size_t>();
  }
  EXPECT_EQ(found.at("samples"), samples);
  const double data = found.at("objective").at("data").get<double>();
  EXPECT_LE(scaled(std::abs(sum - data), data, pieces), few_hundred_eps);
}

/// Logs that are skipped are no neighbours of those that are used.
TEST(BatchThreads, BlocksAreOfTheLogsThatAreUsed) {
  (void)piece_names();
  const json found = done(batch(
      "--skip-refused --divisions 0 --blocks 2 --log piece0.csv piece1.csv absent.csv gone.csv"));
  EXPECT_EQ(found.at("blocks"), 2);
  EXPECT_EQ(found.at("log"), "2 logs");
}

/// Good data that cannot answer end as they do in every verb.
TEST(BatchThreads, ALogThatCannotAnswerIsRefusedByItsCode) {
  Lines brief = trot_log();
  brief.resize(40);
  change(brief, "tau.FR_knee", 0, brief.size(), [](double tau) { return tau + 0.01; });
  scratch_file("brief.csv", joined(brief));
  (void)piece_names();
  const CommandRun run = shapeid(batch("--divisions 0 --log piece0.csv piece1.csv brief.csv"));
  EXPECT_EQ(run.out, "");
  expect_one_line(run, 1, "refused (no-data): 1 of 3 logs are refused: brief.csv: ");
  expect_one_line(shapeid(batch("--divisions 0 --log brief.csv")), 1,
                  "refused (no-data): every log is refused: brief.csv: ");
  // Beside one that is bad input, that is what is said.
  expect_one_line(shapeid(batch("--divisions 0 --log brief.csv absent.csv")), 2,
                  "every log is refused: ");
  // All of them are short for a filter of ten seconds.
  expect_one_line(
      shapeid(batch("--row-cutoff 0.1 --divisions 0 --log " + piece_names())), 1,
      "piece0.csv: refused (no-data): no stretch between gaps is long enough for the filter "
      "of the rows");
}

/// However they are written.
TEST(BatchThreads, TheSameMeasurementsTwiceAreRefused) {
  scratch_file("first.csv", joined(trot_log()));
  Lines again = trot_log();
  change(again, "time", 0, again.size(), [](double t) { return t + 100.0; });
  again.resize(1200);
  scratch_file("again.csv", joined(again));
  expect_one_line(shapeid(batch("--divisions 0 --log first.csv again.csv")), 2,
                  "again.csv: holds measurements of first.csv; each measurement once");
}

TEST(BatchThreads, ABadLogIsNamed) {
  scratch_file("degrees.csv", "time,base.gyro.x\n0,not a number\n");
  for (const std::string bad : {"degrees.csv", "absent.csv"}) {
    for (const bool first : {true, false}) {
      const std::string logs = first ? bad + " piece0.csv piece1.csv piece2.csv"
                                     : "piece0.csv piece1.csv piece2.csv " + bad;
      (void)piece_names();
      const CommandRun run = shapeid(batch("--divisions 0 --log " + logs));
      EXPECT_EQ(run.out, "");
      expect_one_line(run, 2, "1 of 4 logs are refused: " + bad + ":");

      const json skipped = done(batch("--skip-refused --divisions 0 --log " + logs));
      const json without = done(batch("--divisions 0 --log piece0.csv piece1.csv piece2.csv"));
      EXPECT_EQ(skipped.at("samples"), without.at("samples"));
      EXPECT_LE(apart(skipped, without), few_hundred_eps);
      const json& log = skipped.at("logs").at(first ? 0 : 3);
      EXPECT_EQ(log.at("log"), bad);
      EXPECT_TRUE(log.at("refused").is_string());
    }
  }
}

/// What feet are found to touch, and what is said to touch, cannot be summed up.
TEST(BatchThreads, ContactsAreLoggedInAllOrInNone) {
  (void)piece_names();
  Lines log;
  std::ifstream file(scratch() + "/piece1.csv");
  for (std::string line; std::getline(file, line);) log.push_back(line);
  scratch_file("flagless.csv", joined(without_contacts(log)));
  const CommandRun run = shapeid(batch("--divisions 0 --log piece0.csv flagless.csv piece2.csv"));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("flagless.csv: has no contact.* columns, and piece0.csv has some"),
            std::string::npos)
      << run.err;
}

TEST(BatchThreads, NothingToJudgeByIsRefused) {
  (void)piece_names();
  EXPECT_EQ(shapeid(batch("--log piece0.csv")).status, 1);
  EXPECT_EQ(shapeid(batch("--skip-refused --log absent.csv gone.csv")).status, 2);
}

}  // namespace
}  // namespace shapeid::test
