// How soon a point of the grid is handed on, and steps that are exactly the longest: on dyadic
// times, where nothing is rounded.
#include "shapeid/models/resampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled;

constexpr double gap_value = std::numeric_limits<double>::quiet_NaN();
constexpr double row_step = 1.0 / 64.0, grid_rate = 256.0;  // four points of the grid a row

double cubic(double t) { return 1.0 + t * (2.0 + t * (-7.0 + 11.0 * t)); }

MeasuredRow row_at(int k, const Eigen::VectorXd& values) {
  MeasuredRow row;
  row.line = k;
  row.time = row_step * k;
  row.values = values;
  row.contacts = {k};
  return row;
}

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

std::vector<GridRow> drained(Resampler& grid) {
  std::vector<GridRow> out;
  while (std::optional<GridRow> row = grid.next()) out.push_back(std::move(*row));
  return out;
}

/// Rows that arrive in bursts: a slope through two of them would be their noise, divided by
/// nothing.
TEST(ResamplerSteps, RowsCloseTogetherDoNotAmplifyNoise) {
  for (const double apart : {5e-2, 1e-3, 1e-6}) {
    Resampler grid(grid_rate, one(4.0 * row_step));
    double most = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double noise = k % 3 == 0 ? 1.0 : -1.0;
      MeasuredRow row = row_at(k, one(noise));
      grid.push(row);
      if (k % 7 == 0) {  // twice, almost at once
        row.time += apart * row_step;
        row.values = one(-noise);
        grid.push(row);
      }
      for (const GridRow& point : drained(grid)) most = std::max(most, std::abs(point.values[0]));
    }
    constexpr double of_a_cubic = 3.5;  // of values between -1 and 1 on steps not too uneven
    EXPECT_LT(most, of_a_cubic) << apart;
  }
}

// Two measurements on either side make the cubic: a point waits for the second row after it, and
// for no other.
TEST(ResamplerSteps, APointWaitsForTwoRowsAfterIt) {
  Resampler grid(grid_rate, one(4.0 * row_step));
  std::size_t out = 0;
  for (int k = 0; k < 40; ++k) {
    grid.push(row_at(k, one(cubic(row_step * k))));
    for (const GridRow& row : drained(grid)) {
      EXPECT_EQ(row.time, static_cast<double>(out++) / grid_rate);
      EXPECT_EQ(row.starts_segment, out == 1);
      // From the second row on, the cubic is exact.
      if (row.time >= row_step) {
        EXPECT_LT(scaled(std::abs(row.values[0] - cubic(row.time)), 10.0, 4), few_hundred_eps);
      }
    }
    EXPECT_EQ(out, k == 0 ? 1U : 4U * static_cast<std::size_t>(k - 1) + 1U) << k;
    EXPECT_LE(grid.held(), 4U);
  }
  grid.finish();
  // What is left has one row after it, and then none: a parabola, and the last row itself.
  for (const GridRow& row : drained(grid)) {
    EXPECT_EQ(row.time, static_cast<double>(out++) / grid_rate);
    const double a = 37.0 * row_step, b = 38.0 * row_step, c = 39.0 * row_step, t = row.time;
    const double parabola = cubic(t) - 11.0 * (t - a) * (t - b) * (t - c);
    EXPECT_LT(scaled(std::abs(row.values[0] - parabola), 10.0, 4), few_hundred_eps);
  }
  EXPECT_EQ(out, 4U * 39U + 1U);
}

// "Further apart than this leave a gap": a step of exactly the longest does not, and its cubic
// has all its points.
TEST(ResamplerSteps, TheLongestStepIsInterpolated) {
  Resampler grid(grid_rate, one(row_step));
  std::vector<GridRow> out;
  for (int k = 0; k < 40; ++k) {
    grid.push(row_at(k, one(cubic(row_step * k))));
    for (GridRow& row : drained(grid)) out.push_back(std::move(row));
  }
  ASSERT_EQ(out.size(), 4U * 38U + 1U);
  for (const GridRow& row : out) {
    EXPECT_EQ(row.starts_segment, row.time == 0.0);
    if (row.time >= row_step) {
      EXPECT_LT(scaled(std::abs(row.values[0] - cubic(row.time)), 10.0, 4), few_hundred_eps);
    }
  }
  Resampler shorter(grid_rate, one(0.999 * row_step));
  for (int k = 0; k < 10; ++k) shorter.push(row_at(k, one(1.0)));
  for (const GridRow& row : drained(shorter)) {
    EXPECT_TRUE(row.starts_segment);
    EXPECT_EQ(row.time, row_step * std::round(row.time / row_step));
  }
}

// Flags are those of the nearest row; of two that are as near, the newer.
TEST(ResamplerSteps, FlagsAreThoseOfTheNearestRow) {
  Resampler grid(grid_rate, one(4.0 * row_step));
  for (int k = 0; k < 20; ++k) grid.push(row_at(k, one(0.0)));
  grid.finish();
  const std::vector<GridRow> out = drained(grid);
  ASSERT_EQ(out.size(), 4U * 19U + 1U);
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(out[i].contacts.at(0), static_cast<int>((i + 2) / 4)) << i;
  }
}

// A measurement that is late holds everything up for the longest step, and no longer.
TEST(ResamplerSteps, AChannelIsWaitedForAsLongAsItsLongestStep) {
  constexpr int dies = 20, longest = 5;
  Resampler grid(grid_rate, Eigen::Vector2d(longest * row_step, longest * row_step));
  std::size_t out = 0;
  for (int k = 0; k < 60; ++k) {
    grid.push(row_at(k, Eigen::Vector2d(1.0 * k, k <= dies ? 2.0 * k : gap_value)));
    for (const GridRow& row : drained(grid)) {
      ++out;
      EXPECT_LE(row.time, dies * row_step);
    }
    // Its last two points have fewer neighbours, and wait for it to be given up.
    const int known = k <= dies ? k - 1 : k <= dies + longest ? dies - 1 : dies;
    EXPECT_EQ(out, k == 0 ? 1U : 4U * static_cast<std::size_t>(known) + 1U) << k;
  }
  // It comes back: a new segment begins where all are measured.
  for (int k = 60; k < 80; ++k) grid.push(row_at(k, Eigen::Vector2d(1.0 * k, 2.0 * k)));
  const std::vector<GridRow> again = drained(grid);
  ASSERT_FALSE(again.empty());
  EXPECT_EQ(again.front().time, 60 * row_step);
  EXPECT_TRUE(again.front().starts_segment);
  EXPECT_FALSE(again.at(1).starts_segment);
}

}  // namespace
}  // namespace shapeid
