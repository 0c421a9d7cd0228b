#include "shapeid/models/simbody/sensors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/sample_builder.hpp"
#include "shapeid/models/simbody/simulation.hpp"
#include "shapeid/tests/simulation/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

RobotNotes notes() {
  RobotNotes result;
  result.imu.translate(Eigen::Vector3d(0.03, -0.02, 0.05));
  result.imu.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.6, 0.8, 0.0)));
  result.noise_sigma = {{"base.gyro", 0.002}, {"q", 1e-4}, {"tau", 0.1}, {"tau.FL_hip", 0.4}};
  return result;
}

std::vector<SimulatedSample> trot(double duration) {
  SimulationOptions options;
  options.duration = duration;
  std::vector<SimulatedSample> samples;
  simulate(test::quadruped(), options,
           [&](const SimulatedSample& sample) { samples.push_back(sample); });
  return samples;
}

Eigen::Quaterniond attitude(const SimulatedSample& sample) {
  return Eigen::Quaterniond(sample.state.base.linear());
}

/// The columns of one row by name.
std::map<std::string, double> named(const Sensors& sensors, const std::vector<double>& row) {
  std::map<std::string, double> result;
  for (std::size_t i = 0; i < row.size(); ++i) result[sensors.columns()[i]] = row[i];
  return result;
}

Eigen::Vector3d three(const std::map<std::string, double>& row, const std::string& name) {
  return {row.at(name + ".x"), row.at(name + ".y"), row.at(name + ".z")};
}

// What the IMU reads, taken back to the base by the code that reads logs.
TEST(Sensors, ImuReadingsBelongToItsPose) {
  const Robot robot = test::quadruped();
  Sensors sensors(robot, notes(), {false, true, 1});
  const SimulatedSample truth = trot(0.6).back();
  const auto row = named(sensors, sensors.measure(truth.sample, attitude(truth)));
  Sample read;
  set_base(notes().imu, three(row, "base.gyro"), three(row, "base.gyrodot"),
           three(row, "base.accel"), read);
  const Sample& s = truth.sample;
  EXPECT_LT(scaled_difference(read.base_angular_velocity, s.base_angular_velocity, 10),
            few_hundred_eps);
  EXPECT_LT(scaled_difference(read.base_angular_acceleration, s.base_angular_acceleration, 10),
            few_hundred_eps);
  EXPECT_LT(scaled_difference(read.base_specific_force, s.base_specific_force, 10),
            few_hundred_eps);
}

// At rest and level an accelerometer reads g upward, in its own axes.
TEST(Sensors, AccelerometerAtRestReadsGravityInItsAxes) {
  const Robot robot = test::quadruped();
  Sensors sensors(robot, notes(), {false, false, 1});
  Sample rest;
  rest.q = rest.dq = rest.ddq = rest.tau = Eigen::VectorXd::Zero(12);
  rest.in_contact.assign(4, true);
  const auto row = named(sensors, sensors.measure(rest, Eigen::Quaterniond::Identity()));
  const Eigen::Vector3d expected = notes().imu.linear().transpose() * Eigen::Vector3d(0, 0, 9.81);
  EXPECT_LT(scaled_difference(three(row, "base.accel"), expected, 10), few_hundred_eps);
}

// The whole way: simulate, log, read, and have the same samples again.
TEST(Sensors, ALogWithoutNoiseReadsBackAsTheTruth) {
  const Robot robot = test::quadruped();
  Sensors sensors(robot, notes(), {false, true, 1});
  const test::ScratchFolder scratch;
  const std::string path = scratch.path("trot.csv");
  const auto truth = trot(0.9);
  LogWriter writer(path, sensors.columns());
  for (const SimulatedSample& sample : truth) {
    writer.write(sensors.measure(sample.sample, attitude(sample)));
  }
  writer.close();

  MotionOptions options;
  options.smoothing = Smoothing::none;
  options.exact_derivatives = true;
  MotionReader reader(path, robot, notes(), std::nullopt, options);
  std::size_t compared = 0;
  while (const std::optional<Sample> read = reader.next()) {
    const auto found = std::find_if(truth.begin(), truth.end(), [&](const SimulatedSample& s) {
      return s.sample.time == read->time;
    });
    ASSERT_NE(found, truth.end());
    const Sample& s = found->sample;
    ++compared;
    ASSERT_EQ(read->q, s.q);
    ASSERT_EQ(read->dq, s.dq);
    ASSERT_EQ(read->ddq, s.ddq);
    ASSERT_EQ(read->tau, s.tau);
    ASSERT_EQ(read->in_contact, s.in_contact);
    ASSERT_EQ(read->contact_force, s.contact_force);
    ASSERT_LT(scaled_difference(read->base_specific_force, s.base_specific_force, 10),
              few_hundred_eps);
  }
  EXPECT_GT(compared, truth.size() / 2);
}

// Mean, spread and independence of the noise of each channel, against the sigmas of the notes.
TEST(Sensors, NoiseHasTheSigmasOfTheNotes) {
  const Robot robot = test::quadruped();
  Sensors exact(robot, notes(), {false, false, 1});
  Sensors noisy(robot, notes(), {true, false, 7});
  const SimulatedSample sample = trot(0.01).back();
  const std::vector<double> truth = exact.measure(sample.sample, attitude(sample));
  constexpr int N = 20000;
  std::vector<double> sum(truth.size()), squares(truth.size()), neighbours(truth.size());
  for (int i = 0; i < N; ++i) {
    const std::vector<double> row = noisy.measure(sample.sample, attitude(sample));
    for (std::size_t c = 0; c < row.size(); ++c) {
      const double error = row[c] - truth[c];
      sum[c] += error;
      squares[c] += error * error;
      if (c > 0) neighbours[c] += error * (row[c - 1] - truth[c - 1]);
    }
  }
  const auto sigma_of = [](const std::string& column) {
    if (column == "tau.FL_hip") return 0.4;
    if (column.rfind("tau.", 0) == 0) return 0.1;
    if (column.rfind("q.", 0) == 0) return 1e-4;
    if (column.rfind("base.gyro.", 0) == 0) return 0.002;
    return 0.0;
  };
  constexpr double unlikely = 5.0;  // standard errors: one false alarm in a million channels
  double before = 0.0;
  for (std::size_t c = 0; c < truth.size(); ++c) {
    const double sigma = sigma_of(exact.columns()[c]);
    const double spread = std::sqrt(squares[c] / N);
    EXPECT_LE(std::abs(sum[c] / N), unlikely * sigma / std::sqrt(N)) << exact.columns()[c];
    EXPECT_LE(std::abs(spread - sigma), unlikely * sigma / std::sqrt(2.0 * N))
        << exact.columns()[c];
    EXPECT_LE(std::abs(neighbours[c] / N), unlikely * sigma * before / std::sqrt(N))
        << exact.columns()[c];
    before = sigma;
  }
}

TEST(Sensors, TheSeedDecidesTheNoise) {
  const Robot robot = test::quadruped();
  const SimulatedSample sample = trot(0.01).back();
  const auto row = [&](std::uint64_t seed) {
    return Sensors(robot, notes(), {true, false, seed}).measure(sample.sample, attitude(sample));
  };
  EXPECT_EQ(row(3), row(3));
  EXPECT_NE(row(3), row(4));
}

// The fourth moment tells a Gaussian (3) from a uniform (1.8) of the same spread.
TEST(Random, IsGaussian) {
  Random random(12);
  constexpr int N = 100000;
  double fourth = 0.0;
  for (int i = 0; i < N; ++i) fourth += std::pow(random.normal(), 4.0) / N;
  constexpr double standard_error = 9.8 / 316.2;  // sqrt(105 - 9) / sqrt(N)
  EXPECT_LT(std::abs(fourth - 3.0), 5.0 * standard_error);
}

}  // namespace
}  // namespace shapeid
