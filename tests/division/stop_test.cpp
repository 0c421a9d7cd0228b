// When divisions end, and what the run says about it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>

#include "shapeid/reference/division.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/any_model.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/thin_mesh.hpp"

namespace shapeid::reference {
namespace {

/// 1 kg of 4 cm within one cuboid of 40 x 20 x 5 cm.
test::ModelWithRows load_in_region(std::uint64_t seed = 7) {
  test::Draw draw(seed);
  test::ModelWithRows given;
  given.model = test::one_cuboid({0.05, 0.02, 0.1}, {0.4, 0.2, 0.05});
  const auto load = test::cuboid_body(1.0, {0.13, -0.04, 0.098}, {0.04, 0.04, 0.04});
  given.problem = test::load_window(draw, 40, load, 0.01);
  test::use_shapes(given.problem, given.model, 1.0);
  return given;
}

DivisionRun run(const test::ModelWithRows& given, const DivisionOptions& options,
                const std::function<void(const DivisionRun&)>& watch = {}) {
  return divide_and_solve(given.model, given.problem, options, watch);
}

TEST(Stop, AtTheLimit) {
  for (const int limit : {0, 1, 5}) {
    const DivisionRun result =
        run(load_in_region(), {.step = 0.0, .most_divisions = limit, .expected_mass = 1.0});
    EXPECT_EQ(result.stopped_by, "limit");
    EXPECT_EQ(result.history.size(), static_cast<std::size_t>(limit));
    EXPECT_EQ(result.model.shapes.size(), static_cast<std::size_t>(limit) + 1);
  }
}

// Every step is below an infinite eps: patience alone decides.
TEST(Stop, PatienceCountsSmallStepsInARow) {
  for (const int patience : {1, 4}) {
    const DivisionRun result = run(
        load_in_region(),
        {.step = std::numeric_limits<double>::max(), .patience = patience, .expected_mass = 1.0});
    EXPECT_EQ(result.stopped_by, "step");
    EXPECT_EQ(result.history.size(), static_cast<std::size_t>(patience));
  }
}

// Small steps come and go on the way: with a larger eps a streak is interrupted and starts anew.
TEST(Stop, AtTheFirstStreakOfSmallSteps) {
  for (const double eps : {0.1, 0.03, 0.01, 1e-3}) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
      const DivisionRun result = run(load_in_region(seed), {.step = eps, .expected_mass = 1.0});
      ASSERT_EQ(result.stopped_by, "step");
      int in_a_row = 0;
      for (std::size_t k = 0; k < result.history.size(); ++k) {
        in_a_row = result.history[k].step.maxCoeff() < eps ? in_a_row + 1 : 0;
        EXPECT_EQ(in_a_row >= DivisionOptions().patience, k + 1 == result.history.size())
            << "eps " << eps << ", seed " << seed << ", division " << k;
      }
    }
  }
}

TEST(Stop, PointsCannotBeDivided) {
  test::ModelWithRows given = load_in_region();
  given.model.shapes = {{0, make_point({0.1, 0.0, 0.1}, 1e-3), "0"},
                        {0, make_point({-0.1, 0.0, 0.1}, 1e-3), "1"}};
  test::use_shapes(given.problem, given.model, 1.0);
  const DivisionRun result = run(given, {.expected_mass = 1.0});
  EXPECT_EQ(result.stopped_by, "nothing divisible");
  EXPECT_TRUE(result.history.empty());
  EXPECT_GT(result.solution.Phi[0], 0.5);
}

// Forces that pull the wrong way: no shape carries mass, so none is worth a division.
TEST(Stop, WithoutMassNothingIsDivided) {
  test::ModelWithRows given = load_in_region();
  given.problem.F *= -1.0;
  const DivisionRun result = run(given, {.expected_mass = 1.0});
  EXPECT_EQ(result.stopped_by, "nothing divisible");
  EXPECT_EQ(result.solution.Phi, Eigen::VectorXd::Zero(10));
}

/// What is left of a thin mesh when it has been cut as often as it can be.
std::optional<Shape> too_thin_to_cut() {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Shape shape = test::flat_tetrahedron(1e-13, seed);
    for (int cuts = 0; cuts < 100; ++cuts) {
      const auto parts = parts_if_any(shape);
      if (!parts) return shape;
      shape = parts->first;
    }
  }
  return std::nullopt;
}

/// That a mesh is too thin to be cut only the cut tells: then the shape with the next largest v is
/// divided, and at last none. (It was a defect: std::invalid_argument out of divide_and_solve().)
TEST(Stop, WhereMeshesAreTooThinToBeCut) {
  const std::optional<Shape> thin = too_thin_to_cut();
  ASSERT_TRUE(thin);
  test::ModelWithRows given = load_in_region();
  given.model.shapes = {{0, *thin, "0"}};
  test::use_shapes(given.problem, given.model, 1.0);
  given.problem.F = given.problem.Y * given.problem.U.col(0);
  const DivisionOptions five{.step = 0.0, .most_divisions = 5, .expected_mass = 1.0};
  const DivisionRun alone = run(given, five);
  EXPECT_EQ(alone.stopped_by, "nothing divisible");
  EXPECT_TRUE(alone.history.empty());
  EXPECT_NEAR(alone.solution.m[0], 1.0, 1e-2);

  given.model.shapes.push_back(load_in_region().model.shapes[0]);
  given.model.shapes[1].id = "1";
  test::use_shapes(given.problem, given.model, 1.0);
  given.problem.F = given.problem.Y * given.problem.U.rowwise().sum();
  const DivisionRun both = run(given, five);
  ASSERT_EQ(both.stopped_by, "limit");
  for (const DivisionStep& step : both.history) EXPECT_EQ(step.divided.front(), '1');
}

/// Moments and volumes of a thin mesh far from the origin lose digits, and a cut is still no change
/// beyond these.
TEST(Split, OfThinMeshesChangesNothing) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    test::ModelWithRows given = load_in_region();
    given.model.shapes = {{0, test::flat_tetrahedron(1e-4, seed), "0"}};
    test::use_shapes(given.problem, given.model, 1.0);
    const Eigen::VectorXd m = Eigen::VectorXd::Constant(1, 0.7);
    const Split split = split_shape(given.model, given.problem, m, 0).value();
    EXPECT_EQ(why_changed(given.problem, m, split).value_or(""), "") << seed;
  }
}

// The place of every other shape stays: the first part replaces, the second is appended.
TEST(Split, FirstPartReplacesSecondIsAppended) {
  test::ModelWithRows given = load_in_region();
  given.model.shapes.push_back(
      {0, make_cuboid({0.1, 0.1, 0.3}, Eigen::Isometry3d::Identity()), "1"});
  test::use_shapes(given.problem, given.model, 1.0);
  const Split split = split_shape(given.model, given.problem, Eigen::Vector2d(3.0, 1.0), 0).value();
  ASSERT_EQ(split.model.shapes.size(), 3U);
  EXPECT_EQ(split.model.shapes[0].id, "0.0");
  EXPECT_EQ(split.model.shapes[1].id, "1");
  EXPECT_EQ(split.model.shapes[2].id, "0.1");
  EXPECT_EQ(split.start, Eigen::Vector3d(1.5, 1.0, 1.5));
}

// Mass, first moment and tensor of one link, each relative to its own size, worked out again.
TEST(Step, IsRelativeInEveryGroup) {
  const test::ModelWithRows given = load_in_region();
  Eigen::VectorXd before = solve_masses(given.problem).Phi;
  const auto check = [&](const DivisionRun& now) {
    if (now.history.empty()) return;
    const Eigen::VectorXd Phi = now.solution.Phi, change = Phi - before;
    const double mass = Phi[0], tensor = Phi.tail<6>().norm();
    const Eigen::Vector3d& step = now.history.back().step;
    EXPECT_DOUBLE_EQ(step[0], std::abs(change[0]) / mass);
    EXPECT_DOUBLE_EQ(step[1], change.segment<3>(1).norm() / std::sqrt(mass * tensor));
    EXPECT_DOUBLE_EQ(step[2], change.tail<6>().norm() / tensor);
    before = Phi;
  };
  (void)run(given, {.most_divisions = 8, .expected_mass = 1.0}, check);
}

TEST(WarmStart, SavesSystems) {
  int warm = 0, cold = 0;
  (void)run(load_in_region(), {.step = 0.0, .most_divisions = 40, .expected_mass = 1.0},
            [&](const DivisionRun& now) {
              if (now.history.empty()) return;
              warm += now.history.back().iterations;
              cold += solve_masses(now.problem).iterations;
            });
  std::cout << warm << " KKT systems warm, " << cold << " cold\n";
  EXPECT_LT(2 * warm, cold);
}

TEST(Watch, SeesTheUndividedAndEveryDivision) {
  const test::ModelWithRows given = load_in_region();
  std::size_t seen = 0;
  (void)run(given, {.most_divisions = 5, .expected_mass = 1.0}, [&](const DivisionRun& now) {
    EXPECT_EQ(now.history.size(), seen++);
    EXPECT_EQ(now.solution.m.size(), now.problem.shapes());
  });
  EXPECT_EQ(seen, 6U);
}

}  // namespace
}  // namespace shapeid::reference
