// A log that asks for no mass where some is sought: its lines say so, and so does the exit status.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// s, until the first doubt at the latest. Without contacts the rows scatter by what the feet carry.
constexpr double soon_enough = 1.0;

std::vector<json> lines_of(const CommandRun& run) {
  std::vector<json> lines;
  std::istringstream text(run.out);
  for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
  return lines;
}

bool is_doubted(const json& line) { return line.at("doubt") == "no-mass"; }

void expect_no_mass(const std::string& arguments) {
  const CommandRun run = shapeid(arguments);
  expect_one_line(run, 1, "refused (no-mass): ");
  const std::vector<json> lines = lines_of(run);
  const auto first = std::find_if(lines.begin(), lines.end(), is_doubted);
  ASSERT_NE(first, lines.end()) << arguments;
  EXPECT_LT(first->at("time").get<double>(), soon_enough) << arguments;
  for (auto line = first; line != lines.end(); ++line) {
    EXPECT_TRUE(is_doubted(*line)) << arguments << ": " << line->at("time");
  }
}

Lines with_other_sign(Lines log, const std::vector<std::string>& columns, std::size_t first = 0) {
  for (const std::string& column : columns) {
    change(log, column, first, log.size(), [](double x) { return -x; });
  }
  return log;
}

const std::vector<std::string> accelerometer = {"base.accel.x", "base.accel.y", "base.accel.z"};
const std::string whole_body = "track " + quadruped_files + " --whole-body ";

TEST(TrackNoMass, AnAccelerometerOfTheOtherSignIsRefused) {
  scratch_file("turned.csv", joined(with_other_sign(trot_log(), accelerometer)));
  scratch_file("falls.csv", joined(with_other_sign(trot_log(), {"base.accel.z"})));
  expect_no_mass(track("turned.csv"));
  expect_no_mass(track("falls.csv"));
  expect_no_mass(whole_body + "turned.csv");
}

std::vector<std::string> torques() {
  std::vector<std::string> names;
  for (const char* leg : {"FR", "FL", "RR", "RL"}) {
    for (const char* joint : {"abad", "hip", "knee"}) {
      names.push_back(fmt::format("tau.{}_{}", leg, joint));
    }
  }
  return names;
}

TEST(TrackNoMass, TorquesOfTheOtherSignAreRefused) {
  scratch_file("pulls.csv", joined(with_other_sign(trot_log(), torques())));
  expect_no_mass(track("pulls.csv"));
}

/// The Kalman filter, which believes in masses like the given one, has some 60 kg of 11,000.
TEST(TrackNoMass, TorquesInThousandthsAreDoubtedAndRefused) {
  Lines log = trot_log();
  constexpr double thousandths = 1000.0;
  for (const std::string& column : torques()) {
    change(log, column, 0, log.size(), [](double x) { return thousandths * x; });
  }
  scratch_file("thousandths.csv", joined(log));
  const CommandRun run = shapeid(track("thousandths.csv"));
  expect_one_line(run, 1, "refused (torque-scale): thousandths.csv: it asks for 1");
  const std::vector<json> lines = lines_of(run);
  ASSERT_FALSE(lines.empty());
  for (const json& line : lines) {
    if (line.at("time").get<double>() < soon_enough) continue;
    EXPECT_EQ(line.at("doubt"), "torque-scale") << line.at("time");
  }
}

/// A robot that runs is not stopped, nor is its log refused for its end.
TEST(TrackNoMass, TorquesThatGoWrongAtTheEndAreDoubtedAndNotRefused) {
  Lines log = trot_log();
  for (const std::string& column : torques()) {
    change(log, column, log.size() / 2, log.size(), [](double x) { return 1000.0 * x; });
  }
  const std::vector<json> lines = tracked(log);
  EXPECT_EQ(lines.at(lines.size() / 3).at("doubt"), nullptr);
  EXPECT_EQ(lines.back().at("doubt"), "torque-scale");
}

TEST(TrackNoMass, FeetThatNobodyDeclaresAreRefused) {
  scratch_file("trot.csv", joined(trot_log()));
  expect_no_mass(track("--contacts none trot.csv"));
  expect_no_mass(whole_body + "--contacts none trot.csv");
}

/// What is put on, taken off, or found with few rows, is a mass.
TEST(TrackNoMass, SoundLogsAreNotDoubted) {
  const auto expect_sound = [](const Lines& log, const std::string& options) {
    scratch_file("sound.csv", joined(log));
    const CommandRun run = shapeid(fmt::format("track {} {} sound.csv", quadruped_files, options));
    EXPECT_EQ(run.status, 0) << run.err;
    for (const json& line : lines_of(run)) EXPECT_FALSE(is_doubted(line)) << options;
  };
  expect_sound(trot_log(), "--whole-body");
  expect_sound(trot_log(), "--free FR_shank FR_thigh --");
  expect_sound(trot_log(), "--window 1");
  // Nearly the body's own mass, which the answers from before foretell badly.
  expect_sound(simulated("heavy",
                         "--seconds 6.5 --rate 500 --seed 1 --load 4 0.02 -0.01 0.078 "
                         "--load-from 2.5 --load-until 4.5"),
               quadruped_shapes);
}

/// The verdict is on the whole log, in pieces or not; the checkpoint stays.
TEST(TrackNoMass, IsRefusedBesideItsCheckpoint) {
  const Lines log = with_other_sign(trot_log(), accelerometer);
  const std::string options = track("--checkpoint none.json --resume piece.csv");
  std::filesystem::remove(scratch() + "/none.json");
  std::string said;
  for (const std::size_t rows : {std::size_t{1000}, log.size()}) {
    scratch_file("piece.csv", joined(Lines(log.begin(), log.begin() + static_cast<long>(rows))));
    const CommandRun run = shapeid(options);
    expect_one_line(run, 1, "refused (no-mass)");
    said += run.out;
  }
  scratch_file("turned.csv", joined(log));
  EXPECT_EQ(said, shapeid(track("turned.csv")).out);
}

/// A log that found a mass is no refused one, but its last answers are none.
TEST(TrackNoMass, WhatTurnsWhileTheRobotRunsIsDoubtedAndNotRefused) {
  Lines log = {trot_log().front()};
  constexpr double pause = 4.1;  // s, from copy to copy: a gap, behind which filters start anew
  const Lines turned = with_other_sign(trot_log(), accelerometer);
  for (int copy = 0; copy < 4; ++copy) {
    Lines next = copy == 0 ? trot_log() : turned;
    change(next, "time", 0, next.size(), [&](double t) { return t + copy * pause; });
    log.insert(log.end(), next.begin() + 1, next.end());
  }
  const std::vector<json> lines = tracked(log);
  EXPECT_FALSE(is_doubted(lines.at(lines.size() / 4)));
  EXPECT_TRUE(is_doubted(lines.back()));
  EXPECT_LT(lines.back().at("mass").at("tracked").get<double>(), 1e-3);
}

/// Legs in the air, hung from something that no channel knows; and on the ground.
TEST(TrackNoMass, AMeasuredRobotThatHangsIsRefusedAndOneThatWalksIsNot) {
  const std::filesystem::path folder = data_folder() / "mini_cheetah_umich";
  if (!std::filesystem::exists(folder)) {
    GTEST_SKIP() << folder << " is not there (set SHAPEID_DATA)";
  }
  const auto run_on = [&](const std::string& log) {
    const std::string options = fmt::format(
        "track --accept-impossible --robot {}/mini_cheetah_from_mit_constants.urdf "
        "--mapping {}/docs/examples/mini_cheetah.mapping.yaml -",
        folder.string(), SHAPEID_SOURCE_DIR);
    return program(
        in_bash(fmt::format("zcat {}/{}.csv.gz | {}", folder.string(), log, command(options))));
  };
  for (const char* ground : {"concrete_left_circle_val", "middle_pebble_test"}) {
    const CommandRun run = run_on(ground);
    EXPECT_EQ(run.status, 0) << ground << run.err;
    for (const json& line : lines_of(run)) EXPECT_FALSE(is_doubted(line)) << ground;
  }
  const CommandRun hangs = run_on("air_walking_gait_val");
  EXPECT_EQ(hangs.status, 1);
  EXPECT_NE(hangs.err.find("refused (no-mass)"), std::string::npos) << hangs.err;
}

}  // namespace
}  // namespace shapeid::test
