// The verbs on the bundled robot, as the README shows them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/models/version.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

TEST(Verbs, VersionIsThatOfTheProject) {
  const CommandRun run = shapeid("--version");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out, std::string(version) + "\n");
  const std::string project = text_of(SHAPEID_SOURCE_DIR "/CMakeLists.txt");
  EXPECT_NE(project.find(fmt::format("project(shapeid VERSION {} ", version)), std::string::npos);
}

TEST(Verbs, InspectSeesTheBundledRobot) {
  const CommandRun run = shapeid("inspect --json " + robots + "quadruped.urdf");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_EQ(document["links"].size(), 13U);
  EXPECT_TRUE(document["findings"].empty()) << document["findings"].dump(2);
}

TEST(Verbs, InspectSaysWhichInertiaNoBodyCanHave) {
  const std::string robot = scratch_file(
      "rod.urdf",
      "<robot name='rod'>\n<link name='rod'><inertial><mass value='2'/><inertia ixx='1' "
      "iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>\n");
  for (const std::string option : {"", "--json "}) {
    const CommandRun run = shapeid(fmt::format("inspect {}{}", option, robot));
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.err.find("refused (impossible-inertia)"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("short by 0.8"), std::string::npos) << run.out;
    if (option.empty()) {
      EXPECT_NE(run.out.find("rod.urdf:2: link rod: the triangle"), std::string::npos) << run.out;
      continue;
    }
    const auto document = nlohmann::json::parse(run.out);
    ASSERT_EQ(document["findings"].size(), 1U);
    EXPECT_EQ(document["findings"][0]["line"], 2);
    EXPECT_EQ(document["findings"][0]["fatal"], true);
    EXPECT_NEAR(document["links"][0]["consistency_margin"].get<double>(), -0.8, 1e-12);
  }
}

// Simulate, inspect, identify, reread: the files of one verb are the input of the next.
TEST(Verbs, FromSimulationToAnIdentifiedUrdf) {
  const std::string files =
      fmt::format("--robot {0}quadruped.urdf --robot-yaml {0}quadruped.robot.yaml", robots);
  const CommandRun simulated = shapeid("simulate --seconds 10 --out trot.csv.gz");
  ASSERT_EQ(simulated.status, 0) << simulated.err;

  const CommandRun seen = shapeid("inspect trot.csv.gz --json " + files);
  ASSERT_EQ(seen.status, 0) << seen.err;
  const auto motion = nlohmann::json::parse(seen.out);
  EXPECT_TRUE(motion["floating"].get<bool>());
  EXPECT_EQ(motion["gaps"], 0);

  const CommandRun found =
      shapeid(fmt::format("identify {} --log trot.csv.gz --shapes {}quadruped.shapes.yaml "
                          "--divisions 3 --out found --json",
                          files, robots));
  ASSERT_EQ(found.status, 0) << found.err;
  const auto result = nlohmann::json::parse(found.out);
  EXPECT_EQ(result["format"], "shapeid-result-1");
  EXPECT_EQ(result["divisions"].size(), 3U);
  EXPECT_EQ(result["masses"].size(), 14U);
  EXPECT_GT(result["heldout"]["samples"].get<int>(), 0);

  // The identified URDF reads back to the parameters that the result names.
  const Robot reread = read_urdf(scratch() + "/found/identified.urdf").robot;
  const auto& numbers = result["links"][0]["parameters"];
  for (Eigen::Index p = 0; p < 10; ++p) {
    const double expected = numbers[static_cast<std::size_t>(p)].get<double>();
    // Written about the centre of mass, read back about the origin: a few roundings of the whole.
    EXPECT_NEAR(
        reread.links[0].inertia.values[p], expected,
        64 * std::numeric_limits<double>::epsilon() * reread.links[0].inertia.values.norm());
  }

  // problem.json and answer.json are what the library's own readers accept, and they agree.
  const std::string folder = scratch() + "/found/";
  const StatedProblem stated =
      stated_problem_from_json(text_of(folder + "problem.json"), "problem.json");
  const MassProblem& problem = stated.masses;
  const Answer answer = answer_from_json(text_of(folder + "answer.json"), "answer.json");
  EXPECT_EQ(answer.problem_digest, problem_digest(stated));
  EXPECT_EQ(result["problem_digest"], answer.problem_digest);
  EXPECT_EQ(objective(problem, answer.masses).total(), answer.objective);
  EXPECT_GE(answer.masses.minCoeff(), 0.0);

  // The certificate beside them holds, and its floor is below the answer and not far.
  const CommandRun judged = shapeid(fmt::format(
      "certify {0}problem.json {0}answer.json --certificate {0}certificate.json --json", folder));
  ASSERT_EQ(judged.status, 0) << judged.err;
  const auto proof = nlohmann::json::parse(judged.out)["proof"];
  EXPECT_TRUE(proof["optimum_known"].get<bool>());
  EXPECT_LT(proof["floor"].get<double>(), answer.objective);
  EXPECT_GT(proof["floor"].get<double>(), 0.9 * answer.objective);
  const nlohmann::json accepted = {
      {"accepted", true}, {"gap", proof["gap"]}, {"reasons", nlohmann::json::array()}};
  EXPECT_EQ(result["certificate"], accepted);
  EXPECT_EQ(nlohmann::json::parse(text_of(folder + "result.json")), result);

  // Its columns are what the shapes beside them make, and those lie in the undivided ones; the
  // optima of larger sets come in order.
  const nlohmann::json all = {{"declared", 14}, {"agree", 14}, {"inside", 14}};
  EXPECT_EQ(proof["columns"], all);
  const auto& sets = proof["relaxations"];
  EXPECT_GT(sets["masses"]["lower"].get<double>(), 0.0);
  EXPECT_LE(sets["masses"]["upper"].get<double>(), sets["bodies"]["upper"].get<double>());
  EXPECT_LE(sets["bodies"]["upper"].get<double>(), answer.objective);
  EXPECT_GT(sets["bodies"]["lower"].get<double>(),
            (1.0 - 1e-6) * sets["bodies"]["upper"].get<double>());

  // Every division says how far above that floor it is: less and less, and never below.
  EXPECT_EQ(result["objective"]["floor"], proof["floor"]);
  double above = result["objective"]["undivided"].get<double>() - proof["floor"].get<double>();
  for (const auto& division : result["divisions"]) {
    const double now = division["above_floor"].get<double>();
    EXPECT_EQ(now, division["objective_after"].get<double>() - proof["floor"].get<double>());
    EXPECT_LE(now, above);
    above = now;
  }
  EXPECT_GT(above, 0.0);
}

// Without --json the same stands in a table, a line a division.
TEST(Verbs, EveryDivisionOfALoadShowsItsDistanceFromTheFloor) {
  simulated_log("loaded.csv.gz", "--seconds 4 --load 1.5 0.1 -0.04 0.08");
  const CommandRun found = shapeid(fmt::format(
      "load --robot {0}quadruped.urdf --robot-yaml {0}quadruped.robot.yaml --log loaded.csv.gz "
      "--area base -0.2 0.2 -0.1 0.1 0.06 0.1 --divisions 4 --eps 0",
      robots));
  ASSERT_EQ(found.status, 0) << found.err;
  std::istringstream lines(found.out);
  std::string line;
  while (std::getline(lines, line) && line.find("goes below") == std::string::npos) {
  }
  ASSERT_TRUE(lines) << found.out;
  std::getline(lines, line);
  EXPECT_NE(line.find("above floor"), std::string::npos) << line;
  double before = std::numeric_limits<double>::infinity();
  for (int division = 0; division <= 4; ++division) {
    int number = 0, shapes = 0;
    double objective = 0.0, above = 0.0;
    std::getline(lines, line);
    std::istringstream(line) >> number >> shapes >> objective >> above;
    EXPECT_EQ(number, division) << line;
    EXPECT_EQ(shapes, division + 1) << line;
    EXPECT_GT(above, 0.0) << line;
    EXPECT_LE(above, before) << line;
    before = above;
  }
}

TEST(Verbs, OnlinePrintsALinePerWindow) {
  const std::string files =
      fmt::format("--robot {0}quadruped.urdf --robot-yaml {0}quadruped.robot.yaml", robots);
  simulated_log("short.csv", "--seconds 2");
  const CommandRun run = shapeid(fmt::format(
      "identify {} --log short.csv --shapes {}quadruped.shapes.yaml --online", files, robots));
  ASSERT_EQ(run.status, 0) << run.err;
  std::istringstream lines(run.out);
  int windows = 0;
  double last = -1.0;
  for (std::string line; std::getline(lines, line); ++windows) {
    const auto window = nlohmann::json::parse(line);
    EXPECT_GT(window["time"].get<double>(), last);
    last = window["time"].get<double>();
    EXPECT_EQ(window["filtered"].size(), 10U);
    EXPECT_GE(window["filtered"][0].get<double>(), 0.0);
  }
  // One second-order Butterworth by the bilinear transform: sqrt(2) T / (2 tan(pi 20 Hz T)), T = 2
  // ms.
  EXPECT_NE(run.err.find("group delay 11.2 ms"), std::string::npos) << run.err;
  EXPECT_GT(windows, 50);  // two seconds, a window every 20 ms, less what the filter loses at ends
}

}  // namespace
}  // namespace shapeid::test
