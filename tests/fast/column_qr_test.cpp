// A QR decomposition whose columns come and go, against a dense one of the columns that are there.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/fast/column_qr.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::few_hundred_eps;
using test::scaled;

/// The columns that should be in the set, kept beside it.
class ShadowedQr {
 public:
  ShadowedQr(Index rows, Index most, std::uint64_t seed)
      : qr_(rows, most),
        draw_(seed),
        b_(VectorXd::NullaryExpr(rows, [&] { return draw_.sign(); })) {
    qr_.start(b_);
  }

  [[nodiscard]] Index rows() const { return b_.size(); }
  [[nodiscard]] const std::vector<VectorXd>& columns() const { return columns_; }
  [[nodiscard]] int rebuilt() const { return rebuilt_; }

  /// A random column, zero below row `end`, of any magnitude.
  VectorXd random_column(Index end) {
    VectorXd a = VectorXd::Zero(rows());
    const double size = std::pow(10.0, draw_.between(-6.0, 6.0));
    for (double& x : a.head(end)) x = size * draw_.sign();
    return a;
  }

  ColumnQr::Push push_once(const VectorXd& a, Index end) {
    // Rows from `end` on need not be written.
    qr_.entering().setConstant(std::numeric_limits<double>::quiet_NaN());
    qr_.entering().head(end) = a.head(end);
    return qr_.push(end);
  }

  ColumnQr::Push push(const VectorXd& a, Index end) {
    ColumnQr::Push result = push_once(a, end);
    if (result == ColumnQr::Push::crowded) {
      rebuild();
      result = push_once(a, end);
    }
    if (result == ColumnQr::Push::entered) columns_.push_back(a);
    return result;
  }

  /// Several at once: each with its end. As many as entered one after the other would have.
  Index push_all(const std::vector<std::pair<VectorXd, Index>>& columns) {
    std::vector<Index> ends;
    for (const auto& [a, end] : columns) {
      auto entering = qr_.entering(static_cast<Index>(ends.size()));
      entering.setConstant(std::numeric_limits<double>::quiet_NaN());
      entering.head(end) = a.head(end);
      ends.push_back(end);
    }
    const Index entered = qr_.push_all(ends);
    for (Index k = 0; k < entered; ++k) {
      columns_.push_back(columns[static_cast<std::size_t>(k)].first);
    }
    return entered;
  }

  void keep(Index count) {
    qr_.keep(count, b_);
    columns_.resize(static_cast<std::size_t>(count));
  }

  void remove(Index place) {
    const bool removed = qr_.remove(place);
    columns_.erase(columns_.begin() + place);
    if (!removed) rebuild();
  }

  [[nodiscard]] MatrixXd A() const {
    MatrixXd A(rows(), static_cast<Index>(columns_.size()));
    for (Index k = 0; k < A.cols(); ++k) A.col(k) = columns_[static_cast<std::size_t>(k)];
    return A;
  }

  [[nodiscard]] VectorXd dependence() const {
    VectorXd x = VectorXd::Zero(rows());
    qr_.dependence(x);
    return x.head(qr_.size());
  }

  /// Columns are compared at length one: their own units are no matter.
  void check() {
    RC_ASSERT(qr_.size() == static_cast<Index>(columns_.size()));
    if (columns_.empty()) return;
    const VectorXd lengths = A().colwise().norm();
    const MatrixXd unit = A() * lengths.cwiseInverse().asDiagonal();
    VectorXd x = VectorXd::Zero(rows());
    qr_.solve(x);
    x = x.head(qr_.size()).cwiseProduct(lengths).eval();
    const double norms = b_.norm() + x.norm();
    const Index sums = 4 * rows();
    const VectorXd slopes = unit.transpose() * (b_ - unit * x);
    RC_ASSERT(scaled(slopes.lpNorm<Eigen::Infinity>(), norms, sums) < few_hundred_eps);

    const VectorXd sigma = test::singular_values(unit);
    const double condition = sigma.maxCoeff() / sigma.minCoeff();
    // A set may be independent by less than the roundings of its columns (a remainder of 1e-13 in
    // each of several): then coefficients have no digit to compare, and a dense solver divides by
    // zero.
    if (condition < 1.0 / std::numeric_limits<double>::epsilon()) {
      const VectorXd dense = unit.householderQr().solve(b_);
      const double residual = (b_ - unit * dense).norm();
      RC_ASSERT(scaled((x - dense).norm(), condition * (norms + condition * residual), sums) <
                few_hundred_eps);
    }

    // T^T T is A^T A.
    VectorXd z = VectorXd::NullaryExpr(rows(), [&] { return draw_.sign(); });
    const VectorXd right = z.head(qr_.size());
    z.head(qr_.size()) = right.cwiseProduct(lengths);
    qr_.solve_normal(z);
    const VectorXd solved = z.head(qr_.size()).cwiseProduct(lengths);
    const VectorXd left = unit.transpose() * (unit * solved);
    RC_ASSERT(scaled((left - right).norm(), static_cast<double>(sigma.size()) * solved.norm(),
                     sums) < few_hundred_eps);
  }

 private:
  void rebuild() {
    ++rebuilt_;
    qr_.start(b_);
    // One that was new by no more than rounding need not be so again.
    std::vector<VectorXd> all;
    all.swap(columns_);
    for (const VectorXd& a : all) {
      if (push_once(a, rows()) == ColumnQr::Push::entered) {
        columns_.push_back(a);
        continue;
      }
      const MatrixXd unit = A().colwise().normalized();
      const VectorXd left = a - unit * unit.householderQr().solve(a);
      RC_ASSERT(left.norm() <= 100.0 * ColumnQr::smallest_share * a.norm());
    }
  }

  ColumnQr qr_;
  test::Draw draw_;
  VectorXd b_;
  std::vector<VectorXd> columns_;
  int rebuilt_ = 0;
};

RC_GTEST_PROP(ColumnQr, ColumnsComeAndGo, ()) {
  const Index rows = *rc::gen::inRange<Index>(1, 30);
  const Index most = *rc::gen::inRange<Index>(1, rows + 1);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  ShadowedQr set(rows, most, seed);
  test::Draw draw(seed + 1);
  for (int step = 0; step < 60; ++step) {
    const auto count = static_cast<Index>(set.columns().size());
    if (count > 0 && (count == most || draw.between(0.0, 1.0) < 0.4)) {
      set.remove(static_cast<Index>(draw.between(0.0, static_cast<double>(count))));
    } else {
      const auto end = static_cast<Index>(draw.between(1.0, static_cast<double>(rows + 1)));
      const ColumnQr::Push result = set.push(set.random_column(end), end);
      RC_ASSERT(end < rows || result == ColumnQr::Push::entered);
    }
    set.check();
  }
}

// Behind others of which some have left; one of those that come may be twice another.
RC_GTEST_PROP(ColumnQr, ColumnsEnterTogetherAsOneAfterTheOther, ()) {
  const Index rows = *rc::gen::inRange<Index>(2, 40);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Index come = *rc::gen::inRange<Index>(0, rows);
  const Index go = std::min<Index>(*rc::gen::inRange<Index>(0, 3), come);
  const auto let_come_and_go = [&](ShadowedQr& set) {
    for (Index k = 0; k < come; ++k) static_cast<void>(set.push(set.random_column(rows), rows));
    for (Index k = 0; k < go; ++k) set.remove((come - k) / 2);
  };
  ShadowedQr set(rows, rows, seed), one_by_one(rows, rows, seed);
  let_come_and_go(set);
  let_come_and_go(one_by_one);
  test::Draw draw(seed + 1);
  const auto any_end = [&] {
    return static_cast<Index>(draw.between(1.0, static_cast<double>(rows + 1)));
  };
  std::vector<std::pair<VectorXd, Index>> columns(*rc::gen::inRange<std::size_t>(0, 12));
  columns.resize(std::min(columns.size(), static_cast<std::size_t>(rows)));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Index end = any_end();
    columns[k] = {set.random_column(end), end};
    if (k > 0 && draw.between(0.0, 1.0) < 0.1) {
      columns[k] = {2.0 * columns[k - 1].first, columns[k - 1].second};
    }
  }
  std::size_t wanted = 0;
  while (wanted < columns.size() &&
         one_by_one.push_once(columns[wanted].first, columns[wanted].second) ==
             ColumnQr::Push::entered) {
    ++wanted;
  }
  RC_ASSERT(set.push_all(columns) == static_cast<Index>(wanted));
  set.check();
}

// Again and again, which must not fill the room for reflections.
RC_GTEST_PROP(ColumnQr, TheFirstColumnsAreKept, ()) {
  const Index rows = *rc::gen::inRange<Index>(1, 40);
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  ShadowedQr set(rows, rows, seed);
  test::Draw draw(seed + 1);
  for (int turn = 0; turn < 12; ++turn) {
    const auto count = static_cast<Index>(set.columns().size());
    const auto kept = static_cast<Index>(draw.between(0.0, static_cast<double>(count + 1)));
    set.keep(kept);
    set.check();
    std::vector<std::pair<VectorXd, Index>> columns;
    while (kept + static_cast<Index>(columns.size()) < rows && draw.between(0.0, 1.0) < 0.9) {
      columns.emplace_back(set.random_column(rows), rows);
    }
    RC_ASSERT(set.push_all(columns) == static_cast<Index>(columns.size()));
    set.check();
  }
}

// As those of ManyLinks.TheirShapesEnterWhereRoomForReflectionsEnds do: the last ones leave, which
// takes no reflections, and come back.
TEST(ColumnQr, IsCrowdedInTheMidstOfThoseThatEnterTogether) {
  constexpr Index rows = 20, most = 12;
  ShadowedQr set(rows, most, 6);
  for (Index k = 0; k < most; ++k) {
    ASSERT_EQ(set.push(set.random_column(rows), rows), ColumnQr::Push::entered);
  }
  int in_the_midst = 0;
  for (std::size_t turn = 0; turn < 100; ++turn) {
    std::vector<std::pair<VectorXd, Index>> last;
    for (std::size_t k = 0; k < 2 + turn % 3; ++k) {
      last.emplace_back(set.columns().back(), rows);
      set.remove(static_cast<Index>(set.columns().size()) - 1);
    }
    const auto entered = static_cast<std::size_t>(set.push_all(last));
    if (entered > 0 && entered < last.size()) ++in_the_midst;
    for (std::size_t k = entered; k < last.size(); ++k) {
      ASSERT_EQ(set.push(last[k].first, rows), ColumnQr::Push::entered);
    }
    set.check();
  }
  EXPECT_GT(in_the_midst, 0);
  EXPECT_GT(set.rebuilt(), 0);
}

// Columns that leave take room for reflections until a set must be started again.
TEST(ColumnQr, IsCrowdedInTheEndAndStartsAgain) {
  ShadowedQr set(12, 12, 5);
  for (int k = 0; k < 12; ++k) {
    ASSERT_EQ(set.push(set.random_column(12), 12), ColumnQr::Push::entered);
  }
  for (int step = 0; step < 40; ++step) {
    set.remove(0);
    ASSERT_EQ(set.push(set.random_column(12), 12), ColumnQr::Push::entered);
    set.check();
  }
  EXPECT_GE(set.rebuilt(), 5);
}

RC_GTEST_PROP(ColumnQr, SaysWhatADependentColumnIsMadeOf, ()) {
  const Index rows = *rc::gen::inRange<Index>(2, 25);
  ShadowedQr set(rows, rows, *rc::gen::arbitrary<std::uint64_t>());
  const Index count = *rc::gen::inRange<Index>(1, rows);
  for (Index k = 0; k < count; ++k) {
    static_cast<void>(set.push(set.random_column(rows), rows));
  }
  if (count > 1) set.remove(count / 2);
  const MatrixXd A = set.A();
  if (A.cols() == 0) return;
  const VectorXd lengths = A.colwise().norm();
  const VectorXd sum = A * lengths.cwiseInverse();
  RC_ASSERT(set.push(sum, rows) == ColumnQr::Push::dependent);
  const VectorXd x = set.dependence();
  RC_ASSERT(scaled((A * x - sum).norm(), x.cwiseProduct(lengths).norm() + sum.norm(), 4 * rows) <
            few_hundred_eps);
  set.check();  // nothing changed
  // A millionth of something new is enough to enter.
  const VectorXd other = set.random_column(rows);
  RC_ASSERT(set.push(sum / sum.norm() + 1e-6 * other / other.norm(), rows) ==
            ColumnQr::Push::entered);
  set.check();
}

// The inverse of its square overflows; a number of rows that is no multiple of four, so that some
// stand beside zeros.
TEST(ColumnQr, RefusesAColumnTooShortToBeReflectedBy) {
  ShadowedQr set(30, 30, 2);
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(set.push(VectorXd::Constant(30, 1e-155), 30), ColumnQr::Push::dependent);
    EXPECT_EQ(set.push(1e-140 * set.random_column(30), 30), ColumnQr::Push::entered);
    set.check();
  }
}

TEST(ColumnQr, RefusesZerosAndMoreColumnsThanRows) {
  ShadowedQr set(3, 5, 1);
  EXPECT_EQ(set.push(VectorXd::Zero(3), 3), ColumnQr::Push::dependent);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(set.push(set.random_column(3), 3), ColumnQr::Push::entered);
  }
  EXPECT_EQ(set.push(set.random_column(3), 3), ColumnQr::Push::dependent);
}

}  // namespace
}  // namespace shapeid::fast
