// Hundreds of shapes on one link: all columns lie in ten dimensions, neighbours are nearly
// parallel, and only the density term says how much each of them holds.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <limits>
#include <tuple>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;

const Eigen::Vector3d region_lower(-0.2, -0.1, 0.05), region_upper(0.2, 0.1, 0.1);

/// A block in one place has few shapes with mass and a residual that the bounds cause; a load
/// spread over the region is explained exactly, by many shapes, and only lambda decides among them.
const Eigen::Vector3d block(0.04, 0.04, 0.04), spread(0.21, 0.13, 0.04);

/// 1 kg of the given size in a 40 x 20 x 5 cm region that is cut into counts cuboids.
MassProblem load_in_cuboids(const Eigen::Vector3i& counts, const Eigen::Vector3d& size,
                            double relative_noise) {
  test::Draw draw(20240611);
  const auto load = test::cuboid_body(1.0, {0.071, -0.033, 0.074}, size);
  MassProblem p = test::load_window(draw, 40, load, relative_noise);
  test::fill_with_cuboids(p, region_lower, region_upper, counts);
  p.lambda = default_lambda(p, 1.0);
  return p;
}

void expect_optimal(const MassProblem& p, const MassSolution& solution) {
  EXPECT_TRUE((solution.m.array() >= 0.0).all());
  EXPECT_LT(test::scaled(kkt_residual(p, solution.m).worst(), 1.0, p.F.size() + p.shapes()),
            few_hundred_eps);
}

class ManyShapes : public testing::TestWithParam<std::tuple<Eigen::Vector3d, double>> {};

TEST_P(ManyShapes, ThreeHundredColdAndWarm) {
  const MassProblem p =
      load_in_cuboids({12, 5, 5}, std::get<0>(GetParam()), std::get<1>(GetParam()));
  const MassSolution cold = solve_masses(p);
  const MassSolution warm = solve_masses(p, Eigen::VectorXd::Constant(p.shapes(), 1.0 / 300.0));
  expect_optimal(p, cold);
  expect_optimal(p, warm);
  fmt::print("{} KKT systems cold, {} warm, {} of {} shapes with mass, {} apart\n", cold.iterations,
             warm.iterations, (cold.m.array() > 0.0).count(), p.shapes(),
             (cold.m - warm.m).lpNorm<Eigen::Infinity>());
  EXPECT_LT(test::scaled_mass_difference(p, cold.m, warm.m), few_hundred_eps);
  // Sharper: lambda is 1e-12 of || b ||^2 V0 / M0^2, so a rounding of the gradient moves a mass by
  // up to 1e12 roundings of M0, and sums are formed in long double.
  constexpr double amplification = 1e12, M0 = 1.0;
  const double rounding = static_cast<double>(std::numeric_limits<long double>::epsilon());
  EXPECT_LT((cold.m - warm.m).lpNorm<Eigen::Infinity>(),
            few_hundred_eps * amplification * rounding * M0);
}

TEST_P(ManyShapes, WithoutDensityTermColdAndWarmAgreeOnTheObjective) {
  MassProblem p = load_in_cuboids({12, 5, 5}, std::get<0>(GetParam()), std::get<1>(GetParam()));
  p.lambda = 0.0;
  const MassSolution cold = solve_masses(p);
  const MassSolution warm = solve_masses(p, Eigen::VectorXd::Constant(p.shapes(), 1.0 / 300.0));
  expect_optimal(p, cold);
  expect_optimal(p, warm);
  EXPECT_LT(test::scaled_objective_difference(p, cold.m, warm.m), few_hundred_eps);
}

INSTANTIATE_TEST_SUITE_P(SizeAndNoise, ManyShapes,
                         testing::Combine(testing::Values(block, spread),
                                          testing::Values(0.0, 1e-6, 1e-3, 0.05)));

TEST(ManyShapes, AThousand) {
  const MassProblem p = load_in_cuboids({20, 10, 5}, spread, 0.0);
  const MassSolution solution = solve_masses(p);
  expect_optimal(p, solution);
  fmt::print("{} KKT systems, {} of {} shapes with mass\n", solution.iterations,
             (solution.m.array() > 0.0).count(), p.shapes());
}

// The same shape many times over: the density term shares the mass out evenly, by volume.
TEST(ManyShapes, EqualShapesShareByVolume) {
  MassProblem p = load_in_cuboids({1, 1, 1}, block, 0.01);
  p.U = p.U.replicate(1, 60).eval();
  p.V = Eigen::VectorXd::LinSpaced(60, 1.0, 3.0) * p.V[0];
  p.lambda = 1.0;
  const Eigen::VectorXd m = solve_masses(p).m;
  const Eigen::VectorXd density = m.cwiseQuotient(p.V);
  EXPECT_LT(test::scaled_mass_difference(p, m, density.mean() * p.V), few_hundred_eps);
  EXPECT_GT(m.minCoeff(), 0.0);
}

}  // namespace
}  // namespace shapeid::reference
