// A log between its samples, and which of its samples have enough others around them.
#include "shapeid/diagnosis/recording.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double rate_hz = 200.0;

/// A cubic of time for every number of a sample, each another.
Sample cubics(double t) {
  double place = 0.0;
  const auto next = [&] {
    place += 1.0;
    return 0.3 * place - 1.7 * t + (0.2 + place) * t * t - 0.6 * place * t * t * t;
  };
  const auto three = [&] { return Eigen::Vector3d(next(), next(), next()); };
  Sample s;
  s.time = t;
  s.q = three();
  s.dq = three();
  s.ddq = three();
  s.tau = three();
  s.base_angular_velocity = three();
  s.base_angular_acceleration = three();
  s.base_specific_force = three();
  return s;
}

Recording of_cubics() {
  std::vector<Sample> samples(60);
  for (int i = 0; i < 60; ++i) samples[static_cast<std::size_t>(i)] = cubics(i / rate_hz);
  return {std::move(samples), rate_hz};
}

/// Of every number, by samples on both sides: to the left and to the right, within a step and
/// beyond.
TEST(Recording, ACubicIsItselfBetweenItsSamples) {
  const Recording log = of_cubics();
  for (const double steps : {-2.7, -1.0, -0.4, 0.0, 0.25, 0.5, 0.9, 1.6, 3.3}) {
    const Sample got = log.shifted(30, steps / rate_hz);
    const Sample wanted = cubics((30 + steps) / rate_hz);
    const auto expect = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
      EXPECT_LT(test::scaled_difference(a, b, 4), test::few_hundred_eps) << steps;
    };
    EXPECT_NEAR(got.time, wanted.time, 1e-12);
    expect(got.q, wanted.q);
    expect(got.dq, wanted.dq);
    expect(got.ddq, wanted.ddq);
    expect(got.tau, wanted.tau);
    expect(got.base_angular_velocity, wanted.base_angular_velocity);
    expect(got.base_angular_acceleration, wanted.base_angular_acceleration);
    expect(got.base_specific_force, wanted.base_specific_force);
  }
}

/// Of a log of another rate as many samples a second.
TEST(Recording, AStrideOfAnotherRateIsAsFarInTime) {
  const std::vector<Sample> samples = of_cubics().samples();
  const Recording fast(samples, 1000.0), slow(samples, 100.0);
  EXPECT_EQ(fast.stride_for(slow, 10), 1U);
  EXPECT_EQ(fast.stride_for(slow, 3), 1U);
  EXPECT_EQ(slow.stride_for(fast, 2), 20U);
  EXPECT_EQ(slow.stride_for(slow, 7), 7U);
}

TEST(Recording, SaysWhatCannotBeShifted) {
  const Recording log = of_cubics();
  const std::size_t first = log.usable(1).front();
  EXPECT_FALSE(log.why_not_shifted(first, -largest_shift));
  EXPECT_FALSE(log.why_not_shifted(first, largest_shift));
  EXPECT_TRUE(log.why_not_shifted(first, -1.01 * largest_shift));
  EXPECT_TRUE(log.why_not_shifted(first - 1, 0.001));
}

/// The largest shift and the cubic's two samples are within the log at every one that is usable.
TEST(Recording, UsableSamplesCanBeShiftedAsFarAsAnythingIs) {
  const Recording log = of_cubics();
  const std::vector<std::size_t> usable = log.usable(1);
  const auto reach = static_cast<std::size_t>(std::ceil(largest_shift * rate_hz)) + 2;
  ASSERT_FALSE(usable.empty());
  EXPECT_EQ(usable.front(), reach);
  EXPECT_EQ(usable.back(), 59 - reach);
  EXPECT_EQ(usable.size(), 60 - 2 * reach);
  for (const double shift : {-largest_shift, largest_shift}) {
    for (const std::size_t i : {usable.front(), usable.back()}) {
      const Sample s = log.shifted(i, shift);
      EXPECT_NEAR(s.q[1], cubics(log[i].time + shift).q[1], 1e-13);
    }
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
