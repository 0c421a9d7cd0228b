// Where a recording says that gravity pulls.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/diagnosis/recording.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double samples_a_second = 200.0, g = 9.81;
const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
constexpr double turning = 0.7;  // rad/s

Eigen::Quaterniond attitude(double t) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())) *
         Eigen::Quaterniond(Eigen::AngleAxisd(turning * t, axis));
}

/// A base that turns and trots: its acceleration swings by 4 m/s^2, twice a second.
Recording trot() {
  std::vector<Sample> samples(1000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Sample& s = samples[i];
    s.time = static_cast<double>(i) / samples_a_second;
    const double swing = 4.0 * std::sin(2.0 * 3.14159265358979 * 2.0 * s.time);
    s.base_angular_velocity = turning * axis;
    s.base_specific_force =
        attitude(s.time).conjugate() * Eigen::Vector3d(swing, 0.5 * swing, g - 0.3 * swing);
  }
  return {std::move(samples), samples_a_second, {}};
}

double worst_angle(const Recording& log, const auto& down_at) {
  double worst = 0.0;
  constexpr std::size_t from_the_ends = 101;  // there the mean is of less than whole steps
  for (std::size_t i = from_the_ends; i + from_the_ends < log.samples().size(); ++i) {
    const Eigen::Vector3d truth =
        attitude(log[i].time).conjugate() * Eigen::Vector3d(0.0, 0.0, -1.0);
    worst = std::max(worst, std::acos(std::clamp(truth.dot(down_at(i)), -1.0, 1.0)));
  }
  return worst;
}

TEST(Down, StepsOfAGaitCancelAndTheBaseMayTurn) {
  const Recording log = trot();
  constexpr double one_more_reading_than_steps = 0.005;  // 4 m/s^2 of one reading in 201, over g
  EXPECT_LT(worst_angle(log, [&](std::size_t i) { return log.down(i); }),
            one_more_reading_than_steps);
  // The accelerometer alone is off by a quarter of a radian.
  EXPECT_GT(worst_angle(log,
                        [&](std::size_t i) -> Eigen::Vector3d {
                          return -log[i].base_specific_force.normalized();
                        }),
            0.25);
}

TEST(Down, DoesNotReachAcrossAGap) {
  std::vector<Sample> samples(20);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool later = i >= 10;
    samples[i].time = static_cast<double>(i) / samples_a_second + (later ? 1.0 : 0.0);
    samples[i].base_specific_force =
        later ? Eigen::Vector3d(0.0, g, 0.0) : Eigen::Vector3d(g, 0.0, 0.0);
  }
  const Recording log(std::move(samples), samples_a_second, {});
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(log.down(i),
              i < 10 ? Eigen::Vector3d(-1.0, 0.0, 0.0) : Eigen::Vector3d(0.0, -1.0, 0.0))
        << i;
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
