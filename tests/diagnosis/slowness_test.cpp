// Whether a residual is noise.
#include "shapeid/diagnosis/slowness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double filter_cutoff = 15.0;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Given {
  double part = 1.0;             ///< the first of the samples, that counts
  double noise_power = unknown;  ///< of every joint's torque
  double pause = 0.0;            ///< share of the log, in its middle, that has no samples
  double torque = 0.0;           ///< predicted, of every joint
};

/// A residual of three joints at every sample of a log: white noise, and `more` of it at joint 2.
std::vector<Structure> said_of(std::uint32_t seed,
                               const std::function<double(double time, double noise)>& more,
                               const Given& given = {}) {
  const Recording log = test::record({{}, 20.0, 0.02, seed});
  Series series;
  const std::size_t all = log.samples().size();
  const auto until = static_cast<std::size_t>(0.5 * (1.0 - given.pause) * static_cast<double>(all));
  for (std::size_t i = 0; i < all; ++i) {
    if (i < until || i >= all - until) series.index.push_back(i);
  }
  const auto count = std::ssize(series.index);
  series.residual.setZero(3, count);
  series.predicted.setConstant(3, count, given.torque);
  series.counted.setConstant(3, count, true);
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) series.residual(j, i) = noise(generator);
    const double time = log[series.index[static_cast<std::size_t>(i)]].time;
    series.residual(1, i) = more(time, series.residual(1, i));
  }
  const auto counted = static_cast<Eigen::Index>(given.part * static_cast<double>(count));
  series.counted.rightCols(count - counted) = false;
  return slow_remains(test::arm(), log, series, filter_cutoff,
                      {given.noise_power, given.noise_power, given.noise_power});
}

TEST(SlowRemains, NoiseIsNotSlow) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(said_of(seed, [](double, double noise) { return noise; }).empty()) << seed;
  }
}

/// What a log without noise leaves is slow, and nothing.
TEST(SlowRemains, WhatIsNothingBesideTheTorqueIsNotSlow) {
  const auto wave = [](double time, double) { return 100.0 * std::sin(2.0 * time); };
  Given given;
  for (const double torque : {0.0, 1e4}) {
    given.torque = torque;
    EXPECT_EQ(said_of(1, wave, given).size(), 1U) << torque;
  }
  given.torque = 1e6;
  EXPECT_TRUE(said_of(1, wave, given).empty());
}

/// Of a joint that stands still for most of the log neighbouring frequencies say the same: some one
/// in thirty of such joints had been called slow.
TEST(SlowRemains, NoiseOfAJointThatMostlyRestsIsNotSlow) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    EXPECT_TRUE(said_of(seed, [](double, double noise) { return noise; }, {.part = 0.1}).empty())
        << seed;
  }
}

/// Noise of motion is differentiated: it grows with frequency.
TEST(SlowRemains, NoiseOfMotionIsNotSlow) {
  double before = 0.0;
  const auto differences = [&](double, double noise) {
    const double change = noise - before;
    before = noise;
    return 5.0 * change;
  };
  EXPECT_TRUE(said_of(3, differences).empty());
}

TEST(SlowRemains, WhatWandersIsSlow) {
  double place = 0.0;
  const auto found = said_of(3, [&](double, double noise) {
    place = 0.95 * place + 0.2 * noise;
    return noise + place;
  });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].joint, "joint2");
  EXPECT_EQ(found[0].variable, "frequency");
  EXPECT_GT(found[0].share, 0.1);
  EXPECT_LT(found[0].share, 0.6);
  ASSERT_FALSE(found[0].at.empty());
  EXPECT_GT(found[0].value.front(), 1.5 * found[0].value.back());
  EXPECT_LT(found[0].at.back(), 0.5 * filter_cutoff);
}

/// A burst that no curve over a signal shows, because it comes once.
TEST(SlowRemains, ABurstIsSlow) {
  const auto found = said_of(5, [](double time, double noise) {
    return noise + 6.0 * std::exp(-std::pow((time - 9.0) / 0.3, 2));
  });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].joint, "joint2");
}

/// (N m)^2/Hz: what said_of() puts everywhere, at 100 Hz.
constexpr double as_logged = 1.0 / 100.0;

TEST(SlowRemains, NoiseOfTheTorqueIsNotSlowWhateverPartCounts) {
  constexpr Given all{.noise_power = as_logged}, some{.part = 0.3, .noise_power = as_logged},
      both_ends{.noise_power = as_logged, .pause = 0.7};
  for (const Given& given : {all, some, both_ends}) {
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      EXPECT_TRUE(said_of(
                      seed, [](double, double noise) { return noise; }, given)
                      .empty())
          << seed;
    }
  }
}

/// Blows of a gear with play are as strong at all frequencies: a joint of a blind trial, with
/// nineteen times the noise of its torque, followed no signal and was not slow.
TEST(SlowRemains, MoreThanTheNoiseOfTheTorqueIsNoNoiseAtWhateverFrequency) {
  const auto larger = [](double, double noise) { return 3.0 * noise; };
  EXPECT_TRUE(said_of(7, larger).empty());
  const auto found = said_of(7, larger, {.noise_power = as_logged});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].joint, "joint2");
  EXPECT_GT(found[0].t, 4.5);
  EXPECT_NEAR(found[0].value.front(), 3.0, 1.0);
  // A third of the samples says it with a third of the certainty's square.
  const auto less = said_of(7, larger, {.noise_power = as_logged, .pause = 0.7});
  ASSERT_EQ(less.size(), 1U);
  EXPECT_GT(found[0].t, 1.5 * less[0].t);
}

TEST(SlowRemains, NoiseOfMotionIsNotSlowBesideNoiseOfTorque) {
  double before = 0.0;
  const auto differences = [&](double, double noise) {
    const double change = noise - before;
    before = noise;
    return noise + 0.5 * change;
  };
  EXPECT_TRUE(said_of(3, differences, {.noise_power = as_logged}).empty());
}

TEST(SlowRemains, AFilterBelowWhatALogResolvesSaysNothing) {
  const Recording log = test::record({{}, 20.0, 0.02, 1});
  EXPECT_TRUE(
      slow_remains(test::arm(), log, {}, filter_cutoff, {unknown, unknown, unknown}).empty());
}

}  // namespace
}  // namespace shapeid::diagnosis
