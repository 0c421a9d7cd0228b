// The gap that the fast mass solver states is never less than the true one.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::TriangleCase;

/// What rounding does to a gap: to gradients z in <z, m> and in the lowest z.
double terms_of_gap(const TriangleCase& given, const Eigen::VectorXd& m, double mass_bound) {
  const Eigen::VectorXd terms = test::gradient_terms(given.problem, m);
  return terms.dot(m) + mass_bound * terms.maxCoeff();
}

RC_GTEST_PROP(FastGap, NoneAtTheOptimumAndAnUpperBoundAfterDivisions, ()) {
  TriangleCase given = test::body_case(*rc::gen::arbitrary<std::uint64_t>(),
                                       {.links = *rc::gen::inRange(1, 4),
                                        .shapes_a_link = *rc::gen::inRange(1, 5),
                                        .noise = *rc::gen::element(1e-3, 0.3),
                                        .density_term = *rc::gen::arbitrary<bool>()});
  constexpr int divisions = 8;
  fast::MassSolver solver(given.link_count(), given.shapes() + divisions);
  load(given, solver);
  RC_ASSERT(solver.solve(given.R) == fast::Outcome::solved);
  const Eigen::Index size = given.problem.F.size() + given.shapes();
  const auto expect_no_gap = [&] {
    const double bound = solver.m().sum() + 1.0;
    RC_ASSERT(test::scaled(std::abs(solver.gap(bound)), terms_of_gap(given, solver.m(), bound),
                           size) < few_hundred_eps);
  };
  expect_no_gap();
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  for (int k = 0; k < divisions; ++k) {
    const int j = solver.passive().empty() ? 0 : solver.passive().back();
    divide(given, j, draw);
    const int last = given.shapes() - 1;
    RC_ASSERT(solver.divide(j, given.column(j), given.problem.V[j], given.column(last),
                            given.problem.V[last]));
  }
  const Eigen::VectorXd m = solver.m();
  const Eigen::VectorXd optimum = reference::solve_masses(given.problem).m;
  const double bound = std::max(m.sum(), optimum.sum());
  const double missing =
      objective(given.problem, m).total() - objective(given.problem, optimum).total();
  const double terms =
      terms_of_gap(given, m, bound) + test::objective_terms(given.problem, optimum);
  RC_ASSERT(solver.gap(bound) >=
            missing - few_hundred_eps * terms * std::numeric_limits<double>::epsilon());

  RC_ASSERT(solver.solve_again() == fast::Outcome::solved);
  expect_no_gap();
}

// One shape, f = (m - 2)^2: by hand at m = 2, and of another shape that would lower f.
TEST(FastGap, ByHand) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(11, 11);
  R(0, 0) = R(1, 1) = 1.0;
  R(0, 10) = 2.0;
  R(1, 10) = 1.0;
  fast::MassSolver solver(1, 2);
  ASSERT_TRUE(solver.append(0, fast::MassSolver::Column::Unit(0), 1.0));
  ASSERT_EQ(solver.solve(R), fast::Outcome::solved);
  EXPECT_EQ(solver.gap(5.0), 0.0);
  // f falls by 1 with a mass of 1; its slope at none is -2.
  ASSERT_TRUE(solver.append(0, fast::MassSolver::Column::Unit(1), 1.0));
  EXPECT_EQ(solver.gap(5.0), 10.0);
  ASSERT_EQ(solver.solve_again(), fast::Outcome::solved);
  EXPECT_EQ(solver.m(), Eigen::Vector2d(2.0, 1.0));
  EXPECT_EQ(solver.gap(5.0), 0.0);
}

}  // namespace
}  // namespace shapeid
