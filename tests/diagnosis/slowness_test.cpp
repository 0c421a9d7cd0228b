// Whether a residual is noise.
#include "shapeid/diagnosis/slowness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double filter_cutoff = 15.0;

/// A residual of three joints at every sample of a log: white noise, and `more` of it at joint 2.
/// It counts in the log's first part alone, or in all of it.
std::vector<Structure> said_of(std::uint32_t seed,
                               const std::function<double(double time, double noise)>& more,
                               double part = 1.0) {
  const Recording log = test::record({{}, 20.0, 0.02, seed});
  Series series;
  const auto count = static_cast<Eigen::Index>(log.samples().size());
  series.residual.setZero(3, count);
  series.predicted.setZero(3, count);
  series.counted.setConstant(3, count, true);
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise;
  for (Eigen::Index i = 0; i < count; ++i) {
    series.index.push_back(static_cast<std::size_t>(i));
    for (Eigen::Index j = 0; j < 3; ++j) series.residual(j, i) = noise(generator);
    series.residual(1, i) = more(log[static_cast<std::size_t>(i)].time, series.residual(1, i));
  }
  const auto counted = static_cast<Eigen::Index>(part * static_cast<double>(count));
  series.counted.rightCols(count - counted) = false;
  return slow_remains(test::arm(), log, series, filter_cutoff);
}

TEST(SlowRemains, NoiseIsNotSlow) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(said_of(seed, [](double, double noise) { return noise; }).empty()) << seed;
  }
}

/// Of a joint that stands still for most of the log neighbouring frequencies say the same: some one
/// in thirty of such joints had been called slow.
TEST(SlowRemains, NoiseOfAJointThatMostlyRestsIsNotSlow) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    EXPECT_TRUE(said_of(
                    seed, [](double, double noise) { return noise; }, 0.1)
                    .empty())
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

TEST(SlowRemains, AFilterBelowWhatALogResolvesSaysNothing) {
  const Recording log = test::record({{}, 20.0, 0.02, 1});
  EXPECT_TRUE(slow_remains(test::arm(), log, {}, filter_cutoff).empty());
}

}  // namespace
}  // namespace shapeid::diagnosis
