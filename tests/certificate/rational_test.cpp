// Doubles on either side of exact numbers, and exact solutions of linear systems.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>

#include <gmpxx.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/proofs/certificate/exact_solve.hpp"
#include "shapeid/proofs/certificate/linear.hpp"
#include "shapeid/proofs/certificate/modular.hpp"
#include "shapeid/proofs/certificate/rational.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::certificate {
namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr double infinity = std::numeric_limits<double>::infinity();

RC_GTEST_PROP(Rational, LiesBetweenNeighbouringDoubles, ()) {
  const Rational x = exact(*test::real(-1.0, 1.0)) * exact(*test::magnitude(1e-300, 1e300)) /
                     exact(*test::magnitude(1e-3, 1e3));
  const double below = rounded_down(x), above = rounded_up(x);
  RC_ASSERT(exact(below) <= x);
  RC_ASSERT(x <= exact(above));
  RC_ASSERT(above == below || above == std::nextafter(below, infinity));
}

TEST(Rational, BeyondTheDoubles) {
  const Rational huge = exact(largest) * 4;
  EXPECT_EQ(rounded_down(huge), largest);
  EXPECT_EQ(rounded_up(huge), infinity);
  EXPECT_EQ(rounded_down(-huge), -infinity);
  EXPECT_EQ(rounded_up(-huge), -largest);
  const Rational tiny = exact(5e-324) / 8;
  EXPECT_EQ(rounded_down(tiny), 0.0);
  EXPECT_EQ(rounded_up(tiny), 5e-324);
}

RC_GTEST_PROP(Rational, RootsAreAboveAndNear, ()) {
  const Rational x =
      exact(*test::magnitude(1e-300, 1e300)) * exact(*test::magnitude(1e-300, 1e300));
  const Rational root = root_above(x);
  RC_ASSERT(root * root >= x);
  const Rational shorter = root * (1 - exact(std::ldexp(1.0, -60)));
  RC_ASSERT(shorter * shorter <= x);
}

/// By elimination in fractions.
Eigen::Index rank(const Eigen::MatrixXd& A) {
  std::vector<std::vector<mpq_class>> rows;
  for (const auto& row : A.rowwise()) rows.emplace_back(row.begin(), row.end());
  std::size_t found = 0;
  for (std::size_t column = 0; column < static_cast<std::size_t>(A.cols()); ++column) {
    std::size_t pivot = found;
    while (pivot < rows.size() && rows[pivot][column] == 0) ++pivot;
    if (pivot == rows.size()) continue;
    std::swap(rows[pivot], rows[found]);
    for (std::size_t i = found + 1; i < rows.size(); ++i) {
      const mpq_class factor = rows[i][column] / rows[found][column];
      for (std::size_t j = column; j < rows[i].size(); ++j) rows[i][j] -= factor * rows[found][j];
    }
    ++found;
  }
  return static_cast<Eigen::Index>(found);
}

/// Entries over many magnitudes, with rows that are sums of others if singular.
RC_GTEST_PROP(ExactSolve, GivesTheSolutionOrKnowsThereIsNone, ()) {
  const auto n = *rc::gen::inRange<Eigen::Index>(1, 12);
  Eigen::MatrixXd A(n, n);
  for (double& entry : A.reshaped()) {
    entry = std::round(1024.0 * *test::real(-1.0, 1.0)) * std::exp2(*rc::gen::inRange(-40, 40));
  }
  const bool singular = n > 1 && *rc::gen::arbitrary<bool>();
  if (singular) A.row(n - 1) = 2.0 * A.row(0);
  const Eigen::MatrixXd b = *test::vector(n, 1.0);
  const auto x = solve(Dyadic(A), Dyadic(b));
  // Drawn at random, a row of zeros or two of one direction is singular, too.
  RC_ASSERT(x.has_value() == (rank(A) == n));
  if (singular) {
    RC_ASSERT(!x.has_value());
    RC_ASSERT(independent_columns(Dyadic(A)).size() < static_cast<std::size_t>(n));
    return;
  }
  if (!x) return;
  for (Eigen::Index i = 0; i < n; ++i) {
    Rational left;
    for (Eigen::Index j = 0; j < n; ++j) {
      left += exact(A(i, j)) * x->at(static_cast<std::size_t>(j));
    }
    RC_ASSERT(left == exact(b(i, 0)));
  }
}

TEST(ExactSolve, PrimesArePrimeAndFit) {
  const auto p = next_prime(PrimeField::Element{1} << 60U);
  EXPECT_NE(mpz_probab_prime_p(Integer(static_cast<unsigned long>(p)).get_mpz_t(), 30), 0);
  EXPECT_LT(p, PrimeField::Element{1} << 62U);
  const PrimeField field(p);
  EXPECT_EQ(field.times(field.inverse(12345), 12345), 1U);
  // The longest sums of the largest products do not run over.
  const std::vector<PrimeField::Element> most(100, p - 1);
  EXPECT_EQ(field.dot(most.data(), most.data(), most.size()), 100U);
}

/// Against the determinant; small whole numbers are exact in doubles, too.
RC_GTEST_PROP(Linear, TheSideOfATriangle, ()) {
  const auto corner = [] {
    const auto whole = [] { return static_cast<double>(*rc::gen::inRange(-99, 100)); };
    return Eigen::Vector3d(whole(), whole(), whole());
  };
  const Eigen::Vector3d a = corner(), b = corner(), c = corner(), x = corner();
  const double six_volumes = (x - a).dot((b - a).cross(c - a));
  const auto exact3 = [](const Eigen::Vector3d& v) { return exact(Eigen::VectorXd(v)); };
  RC_ASSERT(side_of(exact3(a), exact3(b), exact3(c), exact3(x)) == exact(six_volumes));
}

}  // namespace
}  // namespace shapeid::certificate
