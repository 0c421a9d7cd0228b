// Noise of differentiated positions: from a log with noisy encoders to what diagnose says of it.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/app/motion_noise.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/tests/app/arms.hpp"
#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

constexpr double encoder_noise = 1e-3;  // rad

/// Positions and torques of the arms, whose masses are as given, with this noise of positions.
std::string write_noisy_arms(const std::string& name, double noise) {
  scratch_file(name + ".urdf", arms_urdf(masses_of_arms()));
  write_arms_log(name, masses_of_arms(), {0.02, 0.02});
  Random random(11);
  const auto shake = [&](double& q) { q += noise * random.normal(); };
  write_changed(name + ".csv", name + ".noisy.csv", [&](NamedRow& row) { row.each("q.", shake); },
                {"dq.", "ddq."});
  return fmt::format("--robot {0}.urdf --log {0}.noisy.csv --trust", name);
}

bool any_says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const auto& note) { return note.find(words) != std::string::npos; });
}

/// The noise has no structure of its own: what it seems to have is gone at half the cutoff.
TEST(NoisyEncoders, LeaveNothingUnexplainedAndAreNamed) {
  const auto shaken = diagnosed(write_noisy_arms("shaken", encoder_noise) + " --cutoff 16");
  EXPECT_TRUE(any_says(shaken["notes"], "is faster than 8 Hz, as noise of differentiated"));
  EXPECT_TRUE(any_says(shaken["notes"], "gone behind a filter of 8 Hz, and so not unexplained"));
  EXPECT_EQ(shaken["unexplained"], nlohmann::json::array());
  const auto calm = diagnosed(write_noisy_arms("calm", 0.0) + " --cutoff 16");
  EXPECT_FALSE(any_says(calm["notes"], "faster than"));
}

struct Questioned {
  app::DiagnosisRun run;
  std::vector<std::string> silent;
};

/// A run on noisy arms that found a name, a law and a curve of j1 which are not there; the name
/// takes such a part of the error.
Questioned with_false_findings(const std::string& name, double noise, double gain) {
  write_noisy_arms(name, noise);
  app::MotionInputs inputs;
  inputs.robot = scratch() + "/" + name + ".urdf";
  inputs.log = scratch() + "/" + name + ".noisy.csv";
  inputs.cutoff = 16.0;
  inputs.quiet = true;
  const app::RobotInputs robot = app::read_robot(inputs);
  const app::RecordedLog log = app::read_recording(inputs.log, robot, inputs, std::nullopt);

  app::DiagnosisRun run{{}, {}, {}, {}, {}, {}, {}, {}, log.recording, 1, {}, {}, log.motion, {}};
  run.settings.rows = log.contacts;
  run.settings.weight = app::weight(robot);
  run.settings.size = Eigen::VectorXd::Ones(Eigen::Index{10} * robot.robot.link_count());
  run.settings.cutoff = inputs.cutoff;
  run.settings.stride = app::stride_of(inputs, log.motion.rate);
  run.settings.margin = app::margin_of(inputs, log.motion.rate);
  run.settings.log_starts = log.starts;
  run.loop = diagnosis::close_loop(robot.robot, log.recording, nullptr, run.settings);
  diagnosis::Found offset;
  offset.effect = diagnosis::at_start(*diagnosis::find_effect("torque_offset"), 0);
  offset.effect.value[0] = 0.01;
  offset.id = "torque_offset@j1";
  offset.gain = gain;
  run.loop.found = {offset};
  run.loop.model.effects = {offset.effect};
  diagnosis::Stranger law;
  law.law = {0, diagnosis::Signal::position, 0};
  law.carrier = diagnosis::at_start(*diagnosis::find_effect("torque_offset"), 0);
  run.loop.strangers = {law};
  diagnosis::Structure curve;
  curve.joint = "j1";
  curve.variable = "q.j1";
  run.structures = {curve};

  const std::vector<diagnosis::Found> no_flags;
  app::NoiseOfMotion questions({robot, inputs, {inputs.log}, std::nullopt, log.motion.rate, {}},
                               std::nullopt, no_flags, diagnosis::ContactReach());
  questions.question_laws(log.recording, nullptr, run);
  questions.question_curves(log.recording,
                            diagnosis::series(robot.robot, run.settings.rows, run.loop.model,
                                              log.recording, run.settings.stride),
                            run);
  questions.note(run);
  return {std::move(run), questions.silent()};
}

TEST(NoisyEncoders, WhatIsGoneBehindASlowerFilterIsTakenBackAndSaid) {
  const auto [run, silent] = with_false_findings("suspected", encoder_noise, 0.2);
  EXPECT_TRUE(run.loop.found.empty());
  EXPECT_TRUE(run.loop.model.effects.empty());
  EXPECT_TRUE(run.loop.strangers.empty());
  EXPECT_TRUE(run.structures.empty());
  EXPECT_EQ(silent, std::vector<std::string>{"j1"});
  EXPECT_TRUE(
      any_says(run.notes, "gone behind a filter of 8 Hz, and so no cause: torque_offset@j1"));
  EXPECT_TRUE(any_says(run.notes, "so not unexplained: torque_offset@j1 over q.j1, j1 over q.j1"))
      << fmt::format("{}", fmt::join(run.notes, "\n"));
}

/// Where little of what remains is noise of motion, laws and curves stand, and a name that has its
/// share behind the slower filter.
TEST(NoisyEncoders, WithQuietOnesFindingsStand) {
  const auto [run, silent] = with_false_findings("trusted", 0.0, -1.0);
  ASSERT_EQ(run.loop.found.size(), 1U);
  EXPECT_TRUE(run.loop.found[0].name_stands());
  EXPECT_EQ(run.loop.strangers.size(), 1U);
  EXPECT_EQ(run.structures.size(), 1U);
  EXPECT_TRUE(silent.empty());
  EXPECT_FALSE(any_says(run.notes, "behind a filter of"));
}

/// Such noise may be less than half of what remains, and still have made a name.
TEST(NoisyEncoders, ANameIsAskedOfQuietOnesAsWell) {
  const auto [run, silent] = with_false_findings("doubted", 0.0, 0.2);
  ASSERT_EQ(run.loop.found.size(), 1U);
  EXPECT_FALSE(run.loop.found[0].name_stands());
  EXPECT_EQ(run.structures.size(), 1U);
  EXPECT_TRUE(any_says(run.notes, "lost behind a filter of 8 Hz, and so no cause;"));
  EXPECT_TRUE(any_says(run.notes, "--cutoff 8 leaves less of it: torque_offset@j1"));
}

}  // namespace
}  // namespace shapeid::test
