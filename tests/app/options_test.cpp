// Options of identify and track: each does what its help says, seen in the answer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "shapeid/models/division.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

class Options : public testing::Test {
 protected:
  static void SetUpTestSuite() { simulated_log("trot.csv", "--seconds 3 --seed 4"); }

  static std::vector<json> lines(const std::string& words) {
    const CommandRun run = shapeid(words);
    EXPECT_EQ(run.status, 0) << run.err;
    std::vector<json> result;
    std::istringstream text(run.out);
    for (std::string line; std::getline(text, line);) result.push_back(json::parse(line));
    return result;
  }
  static std::vector<json> online(const std::string& options) {
    return lines(fmt::format("identify {} --log trot.csv {} --online {}", quadruped_files,
                             quadruped_shapes, options));
  }
  static std::vector<json> track(const std::string& options) {
    return lines(
        fmt::format("track trot.csv {} {} {}", quadruped_files, quadruped_shapes, options));
  }
  static json identified(const std::string& options) {
    const CommandRun run = shapeid(fmt::format("identify {} --log trot.csv {} --json {}",
                                               quadruped_files, quadruped_shapes, options));
    EXPECT_EQ(run.status, 0) << run.err;
    return json::parse(run.out);
  }
};

/// A window is answered as soon as it is full, and then every `stride` samples.
TEST_F(Options, WindowsComeAtTheirStride) {
  constexpr double period = 0.002;  // s
  const auto of_ten = online(""), of_forty = online("--window 40 --stride 15");
  const auto time = [](const json& line) { return line["time"].get<double>(); };
  EXPECT_NEAR(time(of_forty[0]) - time(of_ten[0]), 30 * period, 1e-6);
  for (std::size_t i = 1; i < of_forty.size(); ++i) {
    EXPECT_NEAR(time(of_forty[i]) - time(of_forty[i - 1]), 15 * period, 1e-6);
  }
  EXPECT_NE(of_ten[0]["parameters"], of_forty[0]["parameters"]);
}

/// Behind a slow filter swinging feet count as standing for long; that hardly any stands still, and
/// by chance a few more by other axes of the gyro, is no fault of the gyro.
TEST_F(Options, ASlowFilterAccusesNoGyro) {
  simulated_log("long.csv", "--seconds 20 --seed 5");
  const CommandRun run = shapeid(fmt::format("identify {} --log long.csv {} --json --cutoff 6",
                                             quadruped_files, quadruped_shapes));
  EXPECT_EQ(run.status, 0) << run.err;
}

/// Equation (17) with this alpha, from the line before.
TEST_F(Options, AlphaIsTheFilters) {
  for (const double alpha : {0.5, 0.125, 1.0}) {
    const auto windows = online(alpha == 0.5 ? "" : fmt::format("--alpha {}", alpha));
    ASSERT_GT(windows.size(), 20U);
    EXPECT_EQ(windows[0]["filtered"], windows[0]["parameters"]);
    for (std::size_t i = 1; i < windows.size(); ++i) {
      for (std::size_t p = 0; p < 10; ++p) {
        const double now = windows[i]["parameters"][p], last = windows[i - 1]["filtered"][p];
        const double size = std::abs(now) + std::abs(last);
        EXPECT_NEAR(windows[i]["filtered"][p].get<double>(), alpha * now + (1.0 - alpha) * last,
                    4e-16 * size);
      }
    }
  }
}

TEST_F(Options, LambdaIsTheProblems) {
  ASSERT_EQ(shapeid(fmt::format("identify {} --log trot.csv {} --divisions 0 --lambda 0.25 --out l",
                                quadruped_files, quadruped_shapes))
                .status,
            0);
  EXPECT_EQ(json::parse(text_of(scratch() + "/l/problem.json"))["lambda"], 0.25);
  const auto evened = online("--lambda 1e9");
  // So much density term leaves next to no mass.
  EXPECT_LT(evened[10]["parameters"][0].get<double>(), 1e-3);
}

/// Every step counts as small where eps is large, and the last few tell that it is enough.
TEST_F(Options, EpsSaysWhichStepIsSmall) {
  EXPECT_EQ(identified("--divisions 9 --eps 1e9")["divisions"].size(),
            static_cast<std::size_t>(DivisionOptions().patience));
  EXPECT_EQ(identified("--divisions 9 --eps 0")["divisions"].size(), 9U);
}

/// Rows without what is above 5 Hz have less noise to leave.
TEST_F(Options, ARowCutoffFiltersTheEquations) {
  const auto objective = [](const std::string& options) {
    return identified("--divisions 0 --cutoff 80 " + options)["objective"]["undivided"]
        .get<double>();
  };
  const double unfiltered = objective(""), at_50 = objective("--row-cutoff 50"),
               at_5 = objective("--row-cutoff 5");
  EXPECT_LT(at_50, unfiltered);
  EXPECT_LT(at_5, 0.7 * at_50);
}

/// The longer the memory, the steadier the answer: `recent` of the window that it looks back on,
/// `tracked` of how far a parameter may go.
TEST_F(Options, TrackRemembersAsLongAsItIsTold) {
  const auto unrest = [](const std::string& options, const char* which) {
    const auto answers = track(options);
    EXPECT_GT(answers.size(), 20U);
    double sum = 0.0;
    for (std::size_t i = answers.size() / 2; i < answers.size(); ++i) {
      const double now = answers[i]["mass"][which], last = answers[i - 1]["mass"][which];
      sum += std::abs(now - last);
    }
    return sum;
  };
  EXPECT_LT(unrest("--recent 1", "recent"), 0.5 * unrest("--recent 0.05", "recent"));
  EXPECT_LT(unrest("--wander 1e-4", "tracked"), 0.5 * unrest("--wander 1", "tracked"));
}

/// A link at the hip whose tensor no body can have, which is known: its given inertia counts as it
/// is.
TEST_F(Options, AcceptImpossibleTakesAGivenInertiaAsItIsAndSaysSo) {
  std::string text = text_of(robots + "quadruped.urdf");
  const std::string before = "ixx=\"0.00034\"", after = "ixx=\"0.00934\"";
  const std::size_t at = text.find(before);
  ASSERT_NE(at, std::string::npos);
  scratch_file("odd.urdf", text.replace(at, before.size(), after));
  const std::string words = fmt::format(
      "identify --robot odd.urdf --robot-yaml {}quadruped.robot.yaml --log trot.csv {} "
      "--divisions 0 --json ",
      robots, quadruped_shapes);
  const CommandRun refused = shapeid(words);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("odd.urdf:"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("or read it with --accept-impossible where"), std::string::npos)
      << refused.err;
  expect_one_line(shapeid(fmt::format("simulate --robot odd.urdf --robot-yaml "
                                      "{}quadruped.robot.yaml --out odd.csv",
                                      robots)),
                  2, "; correct it, or leave it out\n");
  const CommandRun taken = shapeid(words + "--accept-impossible");
  EXPECT_EQ(taken.status, 0) << taken.err;
  const json result = json::parse(taken.out);
  EXPECT_NE(result["notes"].dump().find("FR_abad_link is taken as it is"), std::string::npos)
      << result["notes"];
  EXPECT_NE(result["links"], identified("--divisions 0")["links"]);
}

}  // namespace
}  // namespace shapeid::test
