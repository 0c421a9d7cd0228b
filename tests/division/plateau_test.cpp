// Small steps where the motion sees nothing of a cut are no end, if a floor tells how much is left.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>

#include "shapeid/reference/division.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/planar_load.hpp"

namespace shapeid::reference {
namespace {

DivisionRun run_above(const test::ModelWithRows& given,
                      const std::function<double(const DivisionRun&)>& floor) {
  return divide_and_solve(given.model, given.problem, {.expected_mass = given.expected_mass}, {},
                          floor);
}

/// No part of any data term.
double floor_at_zero(const DivisionRun&) { return 0.0; }

int cuts_before(const DivisionStep& step) {
  return static_cast<int>(std::count(step.divided.begin(), step.divided.end(), '.'));
}

bool is_small(const DivisionStep& step) { return step.step.maxCoeff() < DivisionOptions().step; }

// The longest side lies across the plane: cuts along it are the first seven.
TEST(Plateau, IsLeftBehindWhereAFloorIsFarBelow) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const test::ModelWithRows given = test::planar_load(seed, 0.0);
    const DivisionRun published = run_above(given, {}), result = run_above(given, floor_at_zero);
    const double undivided = published.history.front().objective_before;
    EXPECT_EQ(published.stopped_by, "step");
    EXPECT_EQ(published.history.size(), static_cast<std::size_t>(DivisionOptions().patience));
    EXPECT_GT(published.solution.value.total(), 0.99 * undivided);
    EXPECT_EQ(result.stopped_by, "step") << seed;
    EXPECT_LT(result.solution.value.data, 1e-2 * undivided) << seed;
    EXPECT_NEAR(result.solution.Phi[0], 1.0, 1e-2) << seed;
    EXPECT_NEAR(result.solution.Phi[1], 0.13, 1e-2) << seed;
    EXPECT_NEAR(result.solution.Phi[3], 0.07, 1e-2) << seed;
  }
}

// The divisions themselves are those of the published rule; there are more of them.
TEST(Plateau, ChangesNoDivision) {
  const test::ModelWithRows given = test::planar_load(1, 0.02);
  const DivisionRun published = run_above(given, {}), result = run_above(given, floor_at_zero);
  ASSERT_GT(result.history.size(), published.history.size());
  for (std::size_t k = 0; k < published.history.size(); ++k) {
    EXPECT_EQ(published.history[k].divided, result.history[k].divided);
    EXPECT_EQ(published.history[k].objective_after, result.history[k].objective_after);
  }
}

// Where the floor is reached when steps become small, the run ends as published.
TEST(Plateau, ThereIsNoneAtTheFloor) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const test::ModelWithRows given = test::planar_load(seed, 0.02);
    const DivisionRun published = run_above(given, {});
    const auto reached = [&](const DivisionRun&) { return published.solution.value.data; };
    EXPECT_EQ(run_above(given, reached).history.size(), published.history.size()) << seed;
  }
}

// A dense spot is cut again and again, and all that is left above the floor is not there.
TEST(Plateau, AStallInASmallPartIsAnEnd) {
  test::Draw draw(7);
  test::ModelWithRows given;
  given.model = test::one_cuboid({0.05, 0.02, 0.1}, {0.4, 0.2, 0.05});
  const auto load = test::cuboid_body(1.0, {0.13, -0.04, 0.098}, {0.04, 0.04, 0.04});
  given.problem = test::load_window(draw, 40, load, 0.05);
  test::use_shapes(given.problem, given.model, 1.0);
  const DivisionRun result = run_above(given, floor_at_zero);
  ASSERT_EQ(result.stopped_by, "step");
  EXPECT_FALSE(is_near_floor(result.history.front().objective_before, result.solution.value, 0.0));
  const auto ends = [&](std::size_t k) {
    const auto first = result.history.begin() + static_cast<std::ptrdiff_t>(k);
    return std::all_of(first, first + DivisionOptions().patience, [](const DivisionStep& step) {
      return is_small(step) && cuts_before(step) >= settled_cuts;
    });
  };
  const std::size_t last =
      result.history.size() - static_cast<std::size_t>(DivisionOptions().patience);
  EXPECT_TRUE(ends(last));
  for (std::size_t k = 0; k < last; ++k) EXPECT_FALSE(ends(k)) << k;
}

TEST(Plateau, TheFloorIsAskedOnceAndOnlyWhereStepsAreSmall) {
  const test::ModelWithRows given = test::planar_load(1, 0.02);
  int asked = 0;
  std::size_t when = 0;
  const DivisionRun result = run_above(given, [&](const DivisionRun& now) {
    ++asked;
    when = now.history.size();
    return 0.0;
  });
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(when, static_cast<std::size_t>(DivisionOptions().patience));
  (void)divide_and_solve(given.model, given.problem, {.step = 0.0, .expected_mass = 1.0}, {},
                         [&](const DivisionRun&) {
                           ++asked;
                           return 0.0;
                         });
  EXPECT_EQ(asked, 1);
}

TEST(Plateau, NearIsLittleOfTheGainOrOfTheRest) {
  EXPECT_TRUE(is_near_floor(200.0, {100.9, 0.0}, 100.0));
  EXPECT_FALSE(is_near_floor(200.0, {101.1, 0.0}, 100.0));
  // As good as explained from the start: there was nothing to gain.
  EXPECT_TRUE(is_near_floor(100.01, {100.009, 0.0}, 100.0));
  EXPECT_FALSE(is_near_floor(100.02, {100.02, 0.0}, 100.0));
  // Without noise the density term is all there is.
  EXPECT_TRUE(is_near_floor(1.0001e-9, {1e-13, 1e-9}, 0.0));
}

}  // namespace
}  // namespace shapeid::reference
