// Hundreds of cuboids that fill one region, as deep divisions leave them: columns in ten
// dimensions, neighbours nearly parallel, and only the density term says how much each of them
// holds.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/fast/agreement.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::Tally;
using test::TriangleCase;

/// A block in one place has few shapes with mass; a load spread over the region is explained by
/// many, among which only lambda decides.
const Eigen::Vector3d block(0.04, 0.04, 0.04), spread(0.21, 0.13, 0.04);

/// 1 kg of the given size in a 40 x 20 x 5 cm region that is cut into counts cuboids.
TriangleCase cuboids(const Eigen::Vector3i& counts, const Eigen::Vector3d& size,
                     double relative_noise) {
  test::Draw draw(20240611);
  const auto load = test::cuboid_body(1.0, {0.071, -0.033, 0.074}, size);
  MassProblem p = test::load_window(draw, 40, load, relative_noise);
  test::fill_with_cuboids(p, {-0.2, -0.1, 0.05}, {0.2, 0.1, 0.1}, counts);
  p.lambda = default_lambda(p, 1.0);
  return test::compressed(p);
}

std::string difference(const TriangleCase& given, const Eigen::VectorXd& start, Tally& tally) {
  fast::MassSolver solver(1, given.shapes());
  load(given, solver);
  test::start_at(start, solver);
  if (solver.solve(given.R) != fast::Outcome::solved) {
    tally.count_declined();
    return "declined";
  }
  const test::Agreement here =
      agreement(given, solver, reference::solve_masses(given.problem, solver.m()).m);
  tally.count(here, solver.iterations());
  return why_not_equal(here, given, solver);
}

class FastCuboids : public testing::TestWithParam<std::tuple<Eigen::Vector3d, double>> {};

TEST_P(FastCuboids, ThreeHundredColdAndWarmAsTheReference) {
  TriangleCase given = cuboids({12, 5, 5}, std::get<0>(GetParam()), std::get<1>(GetParam()));
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(300),
                        even = Eigen::VectorXd::Constant(300, 1.0 / 300.0);
  Tally damped("300 cuboids"), undamped("300 cuboids, lambda = 0");
  EXPECT_EQ(difference(given, none, damped), "");
  EXPECT_EQ(difference(given, even, damped), "");
  given.problem.lambda = 0.0;
  EXPECT_EQ(difference(given, none, undamped), "");
  EXPECT_EQ(difference(given, even, undamped), "");
}

INSTANTIATE_TEST_SUITE_P(SizeAndNoise, FastCuboids,
                         testing::Combine(testing::Values(block, spread),
                                          testing::Values(0.0, 1e-6, 1e-3, 0.05)));

TEST(FastCuboids, AThousand) {
  Tally tally("1000 cuboids");
  const TriangleCase given = cuboids({20, 10, 5}, spread, 0.0);
  EXPECT_EQ(difference(given, Eigen::VectorXd::Zero(1000), tally), "");
}

/// The same shape many times over: the density term shares the mass out evenly, by volume, if its
/// slopes are larger than what the solver follows.
TEST(FastCuboids, EqualShapesShareByVolume) {
  constexpr double followed = 1e-12;  // of a slope's terms: smallest_damped_slope of the solver
  TriangleCase given = cuboids({1, 1, 1}, block, 0.01);
  given.problem.U = given.problem.U.replicate(1, 60).eval();
  given.problem.V = Eigen::VectorXd::LinSpaced(60, 1.0, 3.0) * given.problem.V[0];
  given.links.assign(60, 0);
  const double usual = given.problem.lambda;
  int shared = 0;
  for (const double factor : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    SCOPED_TRACE(factor);
    given.problem.lambda = factor * usual;
    fast::MassSolver solver(1, 60);
    load(given, solver);
    ASSERT_EQ(solver.solve(given.R), fast::Outcome::solved);
    const Eigen::VectorXd m = solver.m(), density = m.cwiseQuotient(solver.V());
    const double slope = given.problem.lambda * density.mean();
    if (slope > followed * test::gradient_terms(given.problem, m).maxCoeff()) {
      ++shared;
      EXPECT_LT(test::scaled_difference(density, Eigen::VectorXd::Constant(60, density.mean()), 60),
                test::few_hundred_eps);
      EXPECT_GT(m.minCoeff(), 0.0);
    }
    // Also where it does not: all that is not decided is the rounding of a slope.
    EXPECT_LT(
        test::scaled_mass_difference(given.problem, m, reference::solve_masses(given.problem).m),
        test::few_hundred_eps);
  }
  EXPECT_EQ(shared, 4);
}

}  // namespace
}  // namespace shapeid
