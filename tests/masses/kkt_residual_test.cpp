// The residual that judges answers must itself notice wrong ones, in every one of its parts.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

/// f = (m1 - 2)^2 + (m2 + 1)^2: least over m >= 0 at (2, 0), with gradient (0, 2).
MassProblem two_apart() {
  MassProblem p;
  p.Y = Eigen::MatrixXd::Identity(2, 10);
  p.F = Eigen::Vector2d(2.0, -1.0);
  p.W = Eigen::Vector2d::Ones();
  p.U = Eigen::MatrixXd::Identity(10, 2);
  p.V = Eigen::Vector2d::Ones();
  return p;
}

TEST(KktResidual, ZeroAtTheOptimum) {
  EXPECT_EQ(kkt_residual(two_apart(), Eigen::Vector2d(2.0, 0.0)).worst(), 0.0);
}

TEST(KktResidual, NegativeMassIsPrimal) {
  const KktResidual residual = kkt_residual(two_apart(), Eigen::Vector2d(2.0, -1.0));
  EXPECT_EQ(residual.primal, 0.5);
  EXPECT_EQ(residual.worst(), 0.5);
}

// Gradient -4 of terms 2 (0 + 2) = 4.
TEST(KktResidual, MassLeftOutIsDual) {
  const KktResidual residual = kkt_residual(two_apart(), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(residual.dual, 1.0);
  EXPECT_EQ(residual.complementarity, 0.0);
}

// Gradient 2 (m2 + 1) = 6 of terms 2 (2 + 1) = 6, at a positive mass.
TEST(KktResidual, MassTooManyIsComplementarity) {
  const KktResidual residual = kkt_residual(two_apart(), Eigen::Vector2d(2.0, 2.0));
  EXPECT_EQ(residual.complementarity, 1.0);
  EXPECT_EQ(residual.dual, 0.0);
}

TEST(KktResidual, DensityTermCounts) {
  MassProblem p = two_apart();
  p.lambda = 1.0;  // moves the optimum to m1 = 1
  EXPECT_EQ(kkt_residual(p, Eigen::Vector2d(1.0, 0.0)).worst(), 0.0);
  EXPECT_GT(kkt_residual(p, Eigen::Vector2d(2.0, 0.0)).complementarity, 0.1);
}

// At mass 2: gradient 2 lambda m / V = 12, of terms 2 (2 + 2) + 12 = 20.
TEST(KktResidual, TheDensityTermIsATermLikeOthers) {
  MassProblem p = two_apart();
  p.lambda = 3.0;
  const KktResidual residual = kkt_residual(p, Eigen::Vector2d(2.0, 0.0));
  EXPECT_EQ(residual.complementarity, 0.6);
  EXPECT_EQ(residual.dual, 0.0);
}

RC_GTEST_PROP(KktResidual, IsFreeOfUnits, ()) {
  const MassProblem p = (*test::planted_problem({.badly_scaled = true})).problem;
  const Eigen::VectorXd m = (*test::vector(p.shapes(), 1.0)).cwiseAbs();
  const double force = *test::magnitude(1e-3, 1e3), weight = *test::magnitude(1e-3, 1e3);
  MassProblem other = p;  // another unit of force, another scale of weights
  other.Y *= force;
  other.F *= force;
  other.W *= weight;
  other.lambda *= force * force * weight;
  const KktResidual a = kkt_residual(p, m), b = kkt_residual(other, m);
  const Eigen::Index size = p.F.size() + p.shapes();
  RC_ASSERT(test::scaled(std::abs(a.dual - b.dual), 1.0, size) < test::few_hundred_eps);
  RC_ASSERT(test::scaled(std::abs(a.complementarity - b.complementarity), 1.0, size) <
            test::few_hundred_eps);
}

}  // namespace
}  // namespace shapeid::reference
