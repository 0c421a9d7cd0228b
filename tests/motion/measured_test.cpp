// Logs of real robots, read with the mapping examples of the guide. The data lie outside the
// project; without them the tests are skipped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid {
namespace {

using test::read_motion;
using test::ReadMotion;

std::filesystem::path data(const std::string& file) { return test::data_folder() / file; }

bool absent(const std::string& file) { return !std::filesystem::exists(data(file)); }

Mapping example(const std::string& name) {
  return read_mapping_yaml(SHAPEID_SOURCE_DIR "/docs/examples/" + name + ".mapping.yaml");
}

Robot robot_of(const std::string& urdf, Root root) {
  UrdfOptions options;
  options.root = root;
  options.reject_impossible = false;
  return read_urdf(data(urdf), options).robot;
}

void print(const std::string& log, const MotionReport& r) {
  fmt::print(
      "{}: {} rows, {} kept, {} samples at {:.1f} Hz, {} gaps, {} lost at ends, {} at contacts\n",
      log, r.rows, r.rows - r.dropped_rows, r.samples, r.rate, r.gaps, r.dropped_at_ends,
      r.dropped_at_contacts);
}

/// rms of what `part` picks from the samples
template <typename Part>
double rms(const ReadMotion& motion, const Part& part) {
  double sum = 0.0;
  for (const Sample& s : motion.samples) sum += part(s).squaredNorm();
  return std::sqrt(sum / static_cast<double>(motion.samples.size()));
}

class MiniCheetah : public testing::TestWithParam<const char*> {};

TEST_P(MiniCheetah, StandsInGravityAndMovesItsLegs) {
  const std::string folder = "mini_cheetah_umich/", log = folder + GetParam() + ".csv.gz";
  if (absent(log)) GTEST_SKIP() << data(log) << " is not there (set SHAPEID_DATA)";
  Robot robot = robot_of(folder + "mini_cheetah_from_mit_constants.urdf", Root::floating);
  const Mapping mapping = example("mini_cheetah");
  add_default_contacts(robot, data(log), mapping);
  ASSERT_EQ(robot.contacts.size(), 4u);
  const ReadMotion motion = read_motion(data(log), robot, {}, mapping);
  print(log, motion.report);
  EXPECT_NEAR(motion.report.rate, 500.0, 1.0);
  // 55 to 61 percent of the rows repeat the joints.
  const double repeated =
      static_cast<double>(motion.report.dropped_rows) / static_cast<double>(motion.report.rows);
  EXPECT_GT(repeated, 0.5);
  EXPECT_LT(repeated, 0.65);
  ASSERT_GT(motion.samples.size(), 500u);
  double force = 0.0;
  for (const Sample& s : motion.samples) force += s.base_specific_force.norm();
  force /= static_cast<double>(motion.samples.size());
  fmt::print("  mean specific force {:.2f} m/s^2, rms dq {:.2f} rad/s\n", force,
             rms(motion, [](const Sample& s) { return s.dq; }));
  EXPECT_GT(force, 9.0);
  EXPECT_LT(force, 13.0);
}

INSTANTIATE_TEST_SUITE_P(Measured, MiniCheetah,
                         testing::Values("air_walking_gait_val", "concrete_right_circle_test",
                                         "concrete_galloping_val", "small_pebble_val"),
                         [](const auto& instance) { return std::string(instance.param); });

/// A chain of joints with these names: reading needs their order only. Limits are those of the
/// widest joint.
Robot arm(const std::vector<std::string>& joints, double limit) {
  Robot robot = test::chain(static_cast<int>(joints.size()), Root::fixed);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Joint& joint = robot.links[j + 1].joint;
    joint.name = joints[j];
    joint.lower = -limit;
    joint.upper = limit;
  }
  return robot;
}

/// rms of a column as it stands in the log
double raw_rms(const std::string& path, const std::string& column) {
  LogReader log(path);
  const auto found = std::find(log.columns().begin(), log.columns().end(), column);
  const std::ptrdiff_t index = found - log.columns().begin();
  double sum = 0.0, count = 0.0;
  while (const std::optional<LogRow> row = log.next()) {
    sum += std::pow(row->values.at(static_cast<std::size_t>(index)), 2);
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

/// Slow motions: filtering and the loss of the ends change no torque's rms by more than this.
void expect_torques_of(const ReadMotion& motion, const std::string& log, const Robot& robot,
                       const std::vector<std::string>& columns,
                       const std::vector<double>& factors) {
  constexpr double slack = 0.05;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double raw = factors[i] * raw_rms(log, columns[i]);
    const double read = rms(motion, [&](const Sample& s) { return s.tau.segment<1>(j); });
    fmt::print("  {}: rms {:.3f} N m, {:.3f} in the log\n", robot.joint(j).name, read, raw);
    EXPECT_LT(std::abs(read - raw), slack * raw) << robot.joint(j).name;
  }
}

TEST(Measured, KukaReadsAtItsRateWithItsOwnTorques) {
  const std::string log = "kuka_lwr4/kuka_lwr4_measurements_2.csv.gz";
  if (absent(log)) GTEST_SKIP() << data(log) << " is not there (set SHAPEID_DATA)";
  std::vector<std::string> joints, columns;
  for (int j = 0; j < 7; ++j) {
    joints.push_back(fmt::format("lwr_{}_joint", j));
    columns.push_back(fmt::format("tau{}_Nm", j + 1));
  }
  const Robot robot = arm(joints, 2.97);
  const ReadMotion motion = read_motion(data(log), robot, {}, example("kuka_lwr4"));
  print(log, motion.report);
  EXPECT_EQ(motion.report.gaps, 0u);
  EXPECT_NEAR(motion.report.rate, 200.0, 2.0);
  EXPECT_GT(motion.report.samples, 4900u);
  expect_torques_of(motion, data(log), robot, columns, std::vector<double>(7, 1.0));

  // The logged velocity, an independent estimate (late by half a sample to one, so its rms
  // difference is 2.5 to 5 ms times the acceleration), agrees with ours.
  MotionOptions logged;
  logged.use_logged_velocity = true;
  const ReadMotion theirs = read_motion(data(log), robot, logged, example("kuka_lwr4"));
  ASSERT_EQ(theirs.samples.size(), motion.samples.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < theirs.samples.size(); ++k) {
    sum += (theirs.samples[k].dq - motion.samples[k].dq).squaredNorm();
  }
  const double difference = std::sqrt(sum / static_cast<double>(theirs.samples.size()));
  const double velocity = rms(motion, [](const Sample& s) { return s.dq; });
  fmt::print("  dq rms {:.3f} rad/s, logged minus derived {:.4f}\n", velocity, difference);
  EXPECT_LT(difference, 0.05 * velocity);
}

// No URDF comes with it.
TEST(Measured, PandaReadsThroughItsJitter) {
  const std::string log = "franka_panda/panda_exciting_traj1_first_half.csv.gz";
  if (absent(log)) GTEST_SKIP() << data(log) << " is not there (set SHAPEID_DATA)";
  std::vector<std::string> joints, columns;
  for (int j = 1; j <= 7; ++j) {
    joints.push_back(fmt::format("panda_joint{}", j));
    columns.push_back(fmt::format("tau{}_Nm", j));
  }
  const Robot robot = arm(joints, 3.8);
  const ReadMotion motion = read_motion(data(log), robot, {}, example("panda"));
  print(log, motion.report);
  EXPECT_GT(motion.report.samples, 9000u);
  expect_torques_of(motion, data(log), robot, columns, std::vector<double>(7, 1.0));
}

TEST(Measured, Ur10eCurrentsBecomeTorques) {
  const std::string folder = "ur10e_load/", log = folder + "ur-20_02_19_14harm50sec.csv.gz";
  if (absent(log)) GTEST_SKIP() << data(log) << " is not there (set SHAPEID_DATA)";
  const Robot robot = robot_of(folder + "ur10e.urdf", Root::fixed);
  MotionOptions options;
  options.cutoff = 5.0;
  const Mapping mapping = example("ur10e");
  const ReadMotion motion = read_motion(data(log), robot, options, mapping);
  print(log, motion.report);
  EXPECT_NEAR(motion.report.rate, 100.0, 5.0);
  EXPECT_GT(motion.report.samples, 4000u);
  std::vector<std::string> columns;
  for (int j = 1; j <= 6; ++j) columns.push_back(fmt::format("i{}_A", j));
  expect_torques_of(motion, data(log), robot, columns,
                    {10.0, 10.6956, 8.4566, 9.0029, 9.48, 10.1232});
}

}  // namespace
}  // namespace shapeid
