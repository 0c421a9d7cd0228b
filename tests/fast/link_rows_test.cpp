// The triangle of one link four numbers at a time: against Eigen in long double.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using test::few_hundred_eps;
using test::scaled;
using test::TriangleCase;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

struct Some {
  explicit Some(std::uint64_t seed, int shapes)
      : given(test::body_case(seed, {.shapes_a_link = shapes, .noise = 1e-2})),
        columns(1, given.shapes()) {
    for (int j = 0; j < given.shapes(); ++j) {
      static_cast<void>(columns.append(0, given.column(j)));
    }
    rows.take(given.R);
  }

  TriangleCase given;
  ShapeColumns columns;
  LinkRows rows;
};

LongVector numbers(const Dozen& dozen) {
  LongVector x(10);
  for (Index i = 0; i < 10; ++i) x[i] = dozen[static_cast<std::size_t>(i)];
  return x;
}

double length(const LongVector& x) { return static_cast<double>(x.norm()); }

RC_GTEST_PROP(LinkRows, AreThoseOfTheTriangle, ()) {
  const Some some(*rc::gen::arbitrary<std::uint64_t>(), 1);
  const Eigen::MatrixXd& R = some.given.R;
  for (Index i = 0; i < 10; ++i) {
    const Dozen& row = some.rows.rows()[static_cast<std::size_t>(i)];
    for (Index j = 0; j < 12; ++j) {
      RC_ASSERT(row[static_cast<std::size_t>(j)] == (j < 11 ? R(i, j) : 0.0));
    }
  }
  const Eigen::VectorXd lengths = R.topLeftCorner(10, 10).cwiseAbs().colwise().sum().transpose();
  RC_ASSERT(length(numbers(some.rows.lengths()) - lengths.cast<long double>()) <=
            1e-15 * lengths.sum());
  RC_ASSERT(some.rows.length() == R.col(10).norm());
}

RC_GTEST_PROP(LinkRows, EvaluateMasses, ()) {
  const Some some(*rc::gen::arbitrary<std::uint64_t>(), *rc::gen::inRange(1, 30));
  const MassProblem& p = some.given.problem;
  std::vector<int> passive;
  std::vector<double> masses;
  LongVector m = LongVector::Zero(p.shapes());
  for (int j = some.given.shapes() - 1; j >= 0; j -= 2) {
    passive.push_back(j);
    masses.push_back(0.3 + 0.1 * j);
    m[j] = masses.back();
  }
  const LongMatrix R = p.Y.cast<long double>(), U = p.U.cast<long double>();
  const LongVector Phi = U * m, r = p.F.cast<long double>() - R * Phi, g = R.transpose() * r;
  LinkRows::Value value;
  some.rows.evaluate(some.columns, passive, masses, value);
  RC_ASSERT(scaled(length(numbers(value.Phi) - Phi), length(Phi), 10) < few_hundred_eps);
  const double size = p.Y.norm() * length(Phi) + p.F.norm();
  RC_ASSERT(scaled(length(numbers(value.slopes) - g), p.Y.norm() * size, 10) < few_hundred_eps);
  RC_ASSERT(scaled(value.square - static_cast<double>(r.squaredNorm()), size * size, 10) <
            few_hundred_eps);
  RC_ASSERT(value.slopes[10] == 0.0 && value.slopes[11] == 0.0);
}

/// Three shapes at places with gaps, and what settle() is asked about.
struct Three {
  explicit Three(const Some& some) {
    for (std::size_t k = 0; k < 3; ++k) {
      shape[places[k]] = static_cast<int>(k);
      used |= 1U << places[k];
      for (int i = 0; i < 10; ++i) {
        U[static_cast<std::size_t>(i)][places[k]] = some.given.column(static_cast<int>(k))[i];
      }
      sizes[places[k]] = some.given.column(static_cast<int>(k))
                             .cwiseAbs()
                             .dot(some.given.problem.Y.cwiseAbs().colwise().sum().transpose());
    }
    const Eigen::MatrixXd A = (some.given.problem.Y * some.given.problem.U).leftCols(3);
    const Eigen::MatrixXd H = (A.transpose() * A).inverse();
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        inverse[places[i]][places[j]] = H(static_cast<Index>(i), static_cast<Index>(j));
      }
    }
    best = H * (A.transpose() * some.given.problem.F);
  }
  [[nodiscard]] AtPlaces at() const { return {&U, inverse.data(), shape.data(), &m, &sizes, used}; }
  void set(const Eigen::VectorXd& masses) {
    for (std::size_t k = 0; k < 3; ++k) m[places[k]] = masses[static_cast<Index>(k)];
  }

  static constexpr std::size_t places[] = {1, 6, 11};
  std::array<Dozen, 10> U;
  std::array<Dozen, 12> inverse;
  std::array<int, 12> shape{};
  Dozen m, sizes;
  unsigned used = 0;
  Eigen::VectorXd best;
};

constexpr double refined = 3e-15, never = 0.0;

// From masses that are off, and with numbers at places that are not in use.
RC_GTEST_PROP(LinkRows, CorrectMassesToTheMinimum, ()) {
  const Some some(*rc::gen::arbitrary<std::uint64_t>(), 3);
  Three three(some);
  RC_PRE((three.best.array() > 0.0).all());
  three.set(three.best * *rc::gen::element(1.0, 1.0 + 1e-9, 0.5));
  three.m[3] = 1e9;
  for (Dozen& row : three.U) row[3] = 1e9;
  three.inverse[3][6] = three.inverse[6][3] = 1e9;
  LinkRows::Settled settled;
  some.rows.settle(some.columns, three.at(), Dozen{}, refined, 3, never, settled);
  RC_ASSERT(settled.is_settled);
  RC_ASSERT(settled.density == 0.0);
  const LongMatrix A =
      some.given.problem.Y.cast<long double>() * some.given.problem.U.cast<long double>();
  LongVector m(3);
  for (std::size_t k = 0; k < 3; ++k) m[static_cast<Index>(k)] = settled.m[Three::places[k]];
  const LongVector g = A.transpose() * (some.given.problem.F.cast<long double>() - A * m);
  for (std::size_t k = 0; k < 3; ++k) {
    RC_ASSERT(std::abs(static_cast<double>(g[static_cast<Index>(k)])) <=
              2.0 * refined * three.sizes[Three::places[k]] * some.rows.length());
  }
  RC_ASSERT(settled.m[3] == 0.0);
}

TEST(LinkRows, SettleOnNoMassThatIsNotPositive) {
  int negative = 0, settled_all = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Some some(seed, 3);
    Three three(some);
    three.set(Eigen::Vector3d(1.0, 1.0, 1.0));
    LinkRows::Settled settled;
    some.rows.settle(some.columns, three.at(), Dozen{}, refined, 3, never, settled);
    const bool is_positive = (three.best.array() > 0.0).all();
    negative += is_positive ? 0 : 1;
    settled_all += settled.is_settled ? 1 : 0;
    EXPECT_EQ(settled.is_settled, is_positive) << seed;
    unsigned below = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(three.best[static_cast<Index>(k)] > 0.0)) below |= 1U << Three::places[k];
    }
    // Where nothing pushes all masses are zero, and rounding says which of them are positive.
    if (three.best.isZero(0.0)) {
      EXPECT_NE(settled.below, 0U) << seed;
    } else {
      EXPECT_EQ(settled.below, below) << seed;
    }
  }
  EXPECT_GT(negative, 10);
  EXPECT_GT(settled_all, 10);
}

// An inverse that is off by a tenth gains a digit a correction: three are too few.
TEST(LinkRows, SettleInAFewCorrectionsOrNotAtAll) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Some some(seed, 3);
    Three three(some);
    if (!(three.best.array() > 0.0).all()) continue;
    three.set(three.best * 1.01);
    for (Dozen& row : three.inverse) {
      for (Four& part : row.part) part *= 1.1;
    }
    LinkRows::Settled settled;
    some.rows.settle(some.columns, three.at(), Dozen{}, refined, 3, never, settled);
    EXPECT_FALSE(settled.is_settled) << seed;
    EXPECT_EQ(settled.corrections, 3);
  }
}

}  // namespace
}  // namespace shapeid::fast
