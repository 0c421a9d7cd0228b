// The demo as the README has it called: its tables, its numbers, and the report that it names.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

using Eigen::Vector3d;

InertialParameters body(const nlohmann::json& numbers) {
  const auto list = numbers.get<std::vector<double>>();
  return {Eigen::Map<const Vector10>(list.data())};
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t found = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++found;
  }
  return found;
}

TEST(Demo, FindsTheBaseAndTheLoad) {
  const CommandRun run = shapeid("demo --json --out demo");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto document = nlohmann::json::parse(run.out);

  // The truths: the bundled robot's base, and a cube of 1 kg and 40 mm on its back.
  const auto robot = read_urdf(SHAPEID_SOURCE_DIR "/models/robots/quadruped.urdf").robot;
  EXPECT_EQ(body(document["base"]["truth"]).values, robot.links[0].inertia.values);
  const InertialParameters load = body(document["load"]["truth"]);
  EXPECT_EQ(load.mass(), 1.0);
  EXPECT_LT((load.centre_of_mass() - Vector3d(0.11, -0.045, 0.078)).norm(), 1e-15);

  // What is left by ten seconds of noisy trot (docs/recovery.md): some percent and centimetres.
  for (const char* part : {"base", "load"}) {
    const InertialParameters truth = body(document[part]["truth"]);
    const InertialParameters found = body(document[part]["found"]);
    EXPECT_NE(found.values, truth.values) << part;
    EXPECT_LT(std::abs(found.mass() - truth.mass()), 0.05 * truth.mass()) << part;
    EXPECT_LT((found.centre_of_mass() - truth.centre_of_mass()).norm(), 0.02) << part;
    EXPECT_EQ(why_impossible(found), std::nullopt) << part;
  }

  const std::string folder = scratch() + "/demo/";
  EXPECT_EQ(document["report"], "demo/report.html");
  const std::string page = text_of(folder + "report.html");
  EXPECT_EQ(count(page, "<table"), 2U);
  EXPECT_EQ(count(page, "<svg"), 2U) << "pictures are in the page, which may be moved";
  EXPECT_EQ(count(page, "src=\"http"), 0U);
  for (const char* picture : {"division.svg", "trace.svg"}) {
    EXPECT_EQ(count(text_of(folder + picture), "</svg>"), 1U) << picture;
  }
  for (const char* log : {"trot.csv.gz", "trot_with_load.csv.gz"}) {
    EXPECT_TRUE(std::filesystem::exists(folder + log)) << log;
  }
}

/// In words: truth, found and their difference in one row, and the report last.
TEST(Demo, EndsByNamingTheReportToOpen) {
  const CommandRun run = shapeid("demo --out other");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(run.out.ends_with("\nopen other/report.html\n")) << run.out;
  std::istringstream lines(run.out);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name, unit;
    double truth = 0.0, found = 0.0, error = 0.0;
    if (!(words >> name >> unit >> truth >> found >> error) || name != "mass") continue;
    ++rows;
    EXPECT_EQ(unit, "kg");
    // Five digits of the masses, two of the error.
    EXPECT_NEAR(error, found - truth, 0.05 * std::abs(error) + 2e-4 * truth) << line;
    EXPECT_NE(error, 0.0) << line;
  }
  EXPECT_EQ(rows, 2) << run.out;
}

TEST(Demo, AFolderThatCannotBeMadeIsSaid) {
  scratch_file("taken", "a file");
  const CommandRun run = shapeid("demo --out taken/demo");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("taken/demo"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace shapeid::test
