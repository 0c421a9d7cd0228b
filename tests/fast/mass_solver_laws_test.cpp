// What must not change the answer of the fast mass solver, and what must change it by a known
// factor.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "shapeid/tests/fast/agreement.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using fast::MassSolver;
using fast::Outcome;
using test::few_hundred_eps;
using test::TriangleCase;

TriangleCase any_problem(bool density_term) {
  return test::body_case(*rc::gen::arbitrary<std::uint64_t>(),
                         {.links = *rc::gen::inRange(1, 5),
                          .shapes_a_link = *rc::gen::inRange(0, 25),
                          .samples = *rc::gen::inRange(0, 8),
                          .noise = *rc::gen::element(0.0, 1e-2),
                          .density_term = density_term});
}

Eigen::VectorXd cold(const TriangleCase& given) {
  MassSolver solver(given.link_count(), given.shapes());
  load(given, solver);
  RC_ASSERT(solver.solve(given.R) == Outcome::solved);
  return solver.m();
}

/// The same minimum, and with the density term the same masses.
void expect_equal(const TriangleCase& given, const Eigen::VectorXd& m1, const Eigen::VectorXd& m2) {
  RC_ASSERT(test::scaled_objective_difference(given.problem, m1, m2) < few_hundred_eps);
  if (!(given.problem.lambda > 0.0)) return;
  RC_ASSERT(test::scaled_mass_difference(given.problem, m1, m2) < few_hundred_eps);
  // A shape that has mass in one alone has a slope no larger than rounding; then masses follow that
  // rounding over lambda, and their difference in units of the problem's terms says it all.
  const bool same_sides = ((m1.array() > 0.0) == (m2.array() > 0.0)).all();
  RC_ASSERT(!same_sides || (m1 - m2).lpNorm<Eigen::Infinity>() <= test::damped_rounding * m2.sum());
}

RC_GTEST_PROP(FastMassLaws, WarmFromAnyStartEqualsCold, ()) {
  const TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  MassSolver solver(given.link_count(), given.shapes());
  load(given, solver);
  test::start_at(test::any_start(*rc::gen::arbitrary<std::uint64_t>(), given), solver);
  RC_ASSERT(solver.solve(given.R) == Outcome::solved);
  expect_equal(given, solver.m(), cold(given));
  // Again, from its own answer: nothing is left to do.
  const Eigen::VectorXd m = solver.m();
  RC_ASSERT(solver.solve(given.R) == Outcome::solved);
  expect_equal(given, solver.m(), m);
  // And from what another window left behind.
  solver.forget_masses();
  RC_ASSERT(solver.m().isZero(0.0));
  RC_ASSERT(solver.passive().empty());
  RC_ASSERT(solver.solve(given.R) == Outcome::solved);
  RC_ASSERT(solver.m() == cold(given));  // bit by bit: no trace of the first
}

RC_GTEST_PROP(FastMassLaws, OneWindowAfterAnother, ()) {
  TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  MassSolver solver(given.link_count(), given.shapes());
  load(given, solver);
  for (const double change : {0.0, 1e-3, 0.5}) {
    given.R.rightCols<1>() += change * given.R.leftCols(given.problem.Y.cols()).rowwise().sum();
    given.problem.F = given.R.rightCols<1>();
    RC_ASSERT(solver.solve(given.R) == Outcome::solved);
    expect_equal(given, solver.m(), cold(given));
  }
}

RC_GTEST_PROP(FastMassLaws, PermutingShapesPermutesMasses, ()) {
  const TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  std::vector<int> order(static_cast<std::size_t>(given.shapes()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(*rc::gen::arbitrary<unsigned>()));
  Eigen::VectorXd back(given.shapes());
  back(order) = cold(permuted(given, order));
  expect_equal(given, back, cold(given));
}

// F -> c F makes m -> c m: both terms of f are of degree two. Powers of two change no digit.
RC_GTEST_PROP(FastMassLaws, MassesFollowTheForces, ()) {
  const TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  const double c = *rc::gen::element(std::ldexp(1.0, -30), std::ldexp(1.0, 30), 1e-6, 3e5);
  TriangleCase other = given;
  other.R.rightCols<1>() *= c;
  expect_equal(given, cold(other) / c, cold(given));
}

RC_GTEST_PROP(FastMassLaws, RowsAndLambdaScaleTogether, ()) {
  const TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  const double c = *test::magnitude(1e-4, 1e4);
  TriangleCase other = given;
  other.R *= c;
  other.problem.lambda *= c * c;
  expect_equal(given, cold(other), cold(given));
}

// A shape in other units of mass: u -> s u, V -> V / s^2, m -> m / s.
RC_GTEST_PROP(FastMassLaws, ShapesOfAnyUnit, ()) {
  const TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  TriangleCase other = given;
  Eigen::VectorXd units(given.shapes());
  for (double& s : units) s = *test::magnitude(1e-4, 1e4);
  other.problem.U = given.problem.U * units.asDiagonal();
  other.problem.V = given.problem.V.cwiseQuotient(units.cwiseAbs2());
  expect_equal(given, cold(other).cwiseProduct(units), cold(given));
}

// Parts of a divided shape start at its own density; what follows equals a fresh solve.
RC_GTEST_PROP(FastMassLaws, DivisionsEqualFreshProblems, ()) {
  TriangleCase given = any_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(given.shapes() > 0);
  constexpr int divisions = 12;
  MassSolver solver(given.link_count(), given.shapes() + divisions);
  load(given, solver);
  RC_ASSERT(solver.solve(given.R) == Outcome::solved);
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  for (int k = 0; k < divisions; ++k) {
    const int j = k % 3 == 0 || solver.passive().empty()
                      ? static_cast<int>(draw.between(0.0, given.shapes()))
                      : solver.passive()[static_cast<std::size_t>(k) % solver.passive().size()];
    const double before = solver.value().total();
    const Eigen::VectorXd Phi = solver.Phi();
    divide(given, j, draw);
    const int last = given.shapes() - 1;
    RC_ASSERT(solver.divide(j, given.column(j), given.problem.V[j], given.column(last),
                            given.problem.V[last]));
    // At lambda = 0 mass may move among shapes that the rows do not tell apart.
    const Eigen::VectorXd now = given.problem.U * solver.m();
    const Eigen::VectorXd sizes = given.problem.U.cwiseAbs() * solver.m();
    RC_ASSERT(test::scaled((given.problem.Y * (now - Phi)).norm(),
                           (given.problem.Y.cwiseAbs() * sizes).norm(),
                           given.shapes()) < few_hundred_eps);
    const double start = objective(given.problem, solver.m()).total();
    const double terms = test::objective_terms(given.problem, solver.m());
    RC_ASSERT(test::scaled(std::abs(start - before), terms, given.problem.F.size()) <
              few_hundred_eps);
    RC_ASSERT(solver.solve_again() == Outcome::solved);
    RC_ASSERT(test::scaled(std::max(0.0, solver.value().total() - before), terms,
                           given.problem.F.size()) < few_hundred_eps);
    expect_equal(given, solver.m(), cold(given));
  }
}

/// Parts may make up the whole to no more than half its digits, as those of a thin mesh do: what
/// is kept of the whole must not be in the answer then. These three cases were off by a thousandth
/// of all mass when the triangle of a link took the parts for the whole (2026-11-28).
TEST(FastMassLaws, PartsThatAddUpRoughlyEqualFreshProblems) {
  struct Case {
    std::uint64_t seed;
    int links, samples;
    double apart;
  };
  constexpr int divisions = 20;
  for (const Case& c : {Case{267, 3, 3, 1e-10}, {58, 3, 3, 1e-9}, {9, 2, 2, 1.4e-8}}) {
    TriangleCase given = test::body_case(
        c.seed, {.links = c.links, .shapes_a_link = 20, .samples = c.samples, .noise = 0.01});
    test::Draw draw(7 * c.seed + 1);
    MassSolver solver(c.links, given.shapes() + divisions);
    load(given, solver);
    ASSERT_EQ(solver.solve(given.R), Outcome::solved);
    double worst = 0.0;
    for (int k = 0; k < divisions; ++k) {
      const auto of = [&](double count) { return static_cast<int>(draw.between(0.0, count)); };
      const bool passive = draw.between(0.0, 1.0) < 0.8;
      const auto passives = static_cast<double>(solver.passive().size());
      const int j =
          passive ? solver.passive()[static_cast<std::size_t>(of(passives))] : of(solver.shapes());
      divide(given, j, draw);
      const int last = given.shapes() - 1;
      for (Eigen::Index i = 1; i < 10; ++i) {
        given.problem.U(Eigen::Index{10} * given.links.back() + i, last) *=
            1.0 + c.apart * draw.sign();
      }
      given.problem.V[last] *= 1.0 + c.apart * draw.sign();
      ASSERT_TRUE(solver.divide(j, given.column(j), given.problem.V[j], given.column(last),
                                given.problem.V[last]));
      if (draw.between(0.0, 1.0) < 0.4) continue;
      ASSERT_EQ(solver.solve_again(), Outcome::solved);
      const Eigen::VectorXd fresh = cold(given);
      worst = std::max(worst, (solver.m() - fresh).lpNorm<Eigen::Infinity>() / fresh.sum());
    }
    EXPECT_LT(worst, 1e-6) << c.seed;
  }
}

}  // namespace
}  // namespace shapeid
