// What must not change the answer of the mass problem, and what must change it by a known factor.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;
using test::planted_problem;
using test::scaled_mass_difference;
using test::scaled_objective_difference;

MassProblem any_problem() {
  return (*planted_problem({.degenerate = true, .near_parallel = true, .badly_scaled = true}))
      .problem;
}

MassProblem any_problem_without_density_term() {
  return (*planted_problem({.zero_lambda = true, .near_parallel = true, .badly_scaled = true}))
      .problem;
}

// Masses of the planted problems' own size, some of them zero.
Eigen::VectorXd any_start(const MassProblem& problem) {
  return (*rc::gen::resize(rc::kNominalSize, test::vector(problem.shapes(), 3.0))).cwiseMax(0.0);
}

RC_GTEST_PROP(MassLaws, WarmEqualsCold, ()) {
  const MassProblem p = any_problem();
  RC_ASSERT(scaled_mass_difference(p, solve_masses(p, any_start(p)).m, solve_masses(p).m) <
            few_hundred_eps);
}

RC_GTEST_PROP(MassLaws, WarmReachesColdObjectiveWithoutDensityTerm, ()) {
  const MassProblem p = any_problem_without_density_term();
  RC_ASSERT(scaled_objective_difference(p, solve_masses(p, any_start(p)).m, solve_masses(p).m) <
            few_hundred_eps);
}

// Shapes are far from changing sides here, so the rounding of m to double changes no set.
RC_GTEST_PROP(MassLaws, OwnAnswerIsConfirmedByOneSystem, ()) {
  const MassProblem p = (*planted_problem({})).problem;
  RC_ASSERT(solve_masses(p, solve_masses(p).m).iterations == 1);
}

RC_GTEST_PROP(MassLaws, PermutingShapesPermutesMasses, ()) {
  const MassProblem p = any_problem();
  Eigen::VectorXi order(p.shapes());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(*rc::gen::arbitrary<unsigned>()));
  MassProblem permuted = p;
  permuted.U = p.U(Eigen::all, order);
  permuted.V = p.V(order);
  Eigen::VectorXd back(p.shapes());
  back(order) = solve_masses(permuted).m;
  RC_ASSERT(scaled_mass_difference(p, back, solve_masses(p).m) < few_hundred_eps);
}

RC_GTEST_PROP(MassLaws, RowOrderDoesNotMatter, ()) {
  const MassProblem p = any_problem();
  MassProblem reversed = p;
  reversed.Y = p.Y.colwise().reverse().eval();
  reversed.F = p.F.reverse().eval();
  reversed.W = p.W.reverse().eval();
  RC_ASSERT(scaled_mass_difference(p, solve_masses(reversed).m, solve_masses(p).m) <
            few_hundred_eps);
}

// F -> c F makes m -> c m: both terms of f are of degree two.
RC_GTEST_PROP(MassLaws, MassesFollowTheForces, ()) {
  const MassProblem p = any_problem();
  const double c = *test::magnitude(1e-6, 1e6);
  MassProblem scaled_up = p;
  scaled_up.F *= c;
  RC_ASSERT(scaled_mass_difference(p, solve_masses(scaled_up).m / c, solve_masses(p).m) <
            few_hundred_eps);
}

// Weights and lambda together scale f, not its minimiser.
RC_GTEST_PROP(MassLaws, WeightsAndLambdaScaleTogether, ()) {
  const MassProblem p = any_problem();
  const double c = *test::magnitude(1e-6, 1e6);
  MassProblem heavier = p;
  heavier.W *= c;
  heavier.lambda *= c;
  RC_ASSERT(scaled_mass_difference(p, solve_masses(heavier).m, solve_masses(p).m) <
            few_hundred_eps);
}

// A weight is a repetition: two equal rows of weight w are one of weight 2 w.
RC_GTEST_PROP(MassLaws, RepeatedRowsAreHeavierRows, ()) {
  const MassProblem p = any_problem();
  const Eigen::Index rows = p.F.size();
  MassProblem twice = p, heavier = p;
  twice.Y = p.Y.replicate(2, 1);
  twice.F = p.F.replicate(2, 1);
  twice.W = p.W.replicate(2, 1);
  heavier.W *= 2.0;
  RC_ASSERT(twice.Y.rows() == 2 * rows);
  RC_ASSERT(scaled_mass_difference(p, solve_masses(twice).m, solve_masses(heavier).m) <
            few_hundred_eps);
}

// No feasible point nearby is better.
RC_GTEST_PROP(MassLaws, NoNeighbourIsLower, ()) {
  const MassProblem p = any_problem();
  const Eigen::VectorXd m = solve_masses(p).m;
  const Eigen::VectorXd other =
      (m + *test::magnitude(1e-8, 1.0) * *test::vector(p.shapes(), 1.0)).cwiseMax(0.0);
  const double rise = objective(p, other).total() - objective(p, m).total();
  RC_ASSERT(rise >= 0.0 || scaled_objective_difference(p, other, m) < few_hundred_eps);
}

TEST(MassLaws, NoShapes) {
  MassProblem p;
  p.Y = Eigen::MatrixXd::Ones(3, 10);
  p.F = Eigen::Vector3d(1.0, -2.0, 0.5);
  p.W = Eigen::Vector3d(1.0, 2.0, 4.0);
  p.U.resize(10, 0);
  p.V.resize(0);
  const MassSolution solution = solve_masses(p);
  EXPECT_EQ(solution.m.size(), 0);
  EXPECT_EQ(solution.Phi, Eigen::VectorXd::Zero(10));
  EXPECT_EQ(solution.value.data, 1.0 + 8.0 + 1.0);
}

TEST(MassLaws, NoRows) {
  MassProblem p;
  p.Y.resize(0, 10);
  p.F.resize(0);
  p.W.resize(0);
  p.U = Eigen::MatrixXd::Ones(10, 2);
  p.V = Eigen::Vector2d(1.0, 2.0);
  p.lambda = 1e-3;
  EXPECT_EQ(solve_masses(p, Eigen::Vector2d(1.0, 0.0)).m, Eigen::Vector2d::Zero());
}

// No masses are given out for numbers that are none, or whose products overflow.
TEST(MassLaws, WhatIsNoNumberIsRefused) {
  for (const double force : {std::numeric_limits<double>::quiet_NaN(), 1e200}) {
    MassProblem p;
    p.Y = force * Eigen::RowVectorXd::Unit(10, 0);
    p.F = Eigen::VectorXd::Constant(1, force);
    p.W = Eigen::VectorXd::Constant(1, 1e300);
    p.U = Eigen::VectorXd::Unit(10, 0);
    p.V = Eigen::VectorXd::Ones(1);
#ifndef NDEBUG
    if (std::isnan(force)) continue;  // which a contract says before
#endif
    EXPECT_THROW(static_cast<void>(solve_masses(p)), Refusal) << force;
  }
}

// One shape, one row, by hand: f = 2 (3 m - 6)^2 + 4 m^2 / 0.5 is least at m = 36 / 26.
TEST(MassLaws, OneShapeByHand) {
  MassProblem p;
  p.Y = 3.0 * Eigen::RowVectorXd::Unit(10, 0);
  p.F = Eigen::VectorXd::Constant(1, 6.0);
  p.W = Eigen::VectorXd::Constant(1, 2.0);
  p.U = Eigen::VectorXd::Unit(10, 0);
  p.V = Eigen::VectorXd::Constant(1, 0.5);
  p.lambda = 4.0;
  EXPECT_DOUBLE_EQ(solve_masses(p).m[0], 36.0 / 26.0);
  p.F[0] = -6.0;  // pulls the other way: the bound holds
  EXPECT_EQ(solve_masses(p).m[0], 0.0);
  EXPECT_TRUE(solve_masses(p).active[0]);
}

// A shape that no row feels takes no mass, with and without the density term, from any start.
TEST(MassLaws, UnfeltShape) {
  MassProblem p;
  p.Y = Eigen::RowVectorXd::Unit(10, 0);
  p.F = Eigen::VectorXd::Constant(1, 1.0);
  p.W = Eigen::VectorXd::Constant(1, 1.0);
  p.U = Eigen::MatrixXd::Zero(10, 2);
  p.U(0, 0) = 1.0;
  p.U(9, 1) = 1.0;
  p.V = Eigen::Vector2d(1.0, 1.0);
  for (const double lambda : {0.0, 1e-12}) {
    p.lambda = lambda;
    EXPECT_EQ(solve_masses(p, Eigen::Vector2d(0.0, 5.0)).m[1], 0.0);
    EXPECT_EQ(solve_masses(p).m[1], 0.0);
  }
}

}  // namespace
}  // namespace shapeid::reference
