// fast::Triangle against the rows themselves and against reference::triangle.
#include "shapeid/fast/triangle.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <type_traits>
#include <utility>

#include "shapeid/models/contract.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::Triangle;
using test::few_hundred_eps;
using test::scaled;

static_assert(
    noexcept(std::declval<Triangle&>().add(std::declval<const Eigen::Ref<const MatrixXd>&>(),
                                           std::declval<const Eigen::Ref<const VectorXd>&>())));
static_assert(noexcept(std::declval<Triangle&>().merge(std::declval<const Triangle&>())));
static_assert(noexcept(std::declval<Triangle&>().clear()));

/// Rows [Y F] whose columns differ in size by up to 1e12, as those of mass and of small tensors do;
/// some columns are zero or depend on others, as those of a fixed base's first links do.
MatrixXd arbitrary_rows(Index columns, Index most_rows) {
  const Index rows = *rc::gen::inRange<Index>(0, most_rows + 1);
  MatrixXd result(rows, columns);
  result.reshaped() = *test::vector(rows * columns, 1.0);
  for (Index j = 0; j < columns; ++j) {
    switch (*rc::gen::inRange(0, 6)) {
      case 0:
        result.col(j).setZero();
        break;
      case 1:
        if (j > 0) result.col(j) = result.col(j - 1) - 2.0 * result.col(0);
        break;
      default:
        break;
    }
  }
  for (Index j = 0; j < columns; ++j) result.col(j) *= *test::magnitude(1e-6, 1e6);
  return result;
}

void add(Triangle& triangle, const MatrixXd& rows) {
  triangle.add(rows.leftCols(rows.cols() - 1), rows.col(rows.cols() - 1));
}

Triangle triangle_of(const MatrixXd& rows) {
  Triangle result(rows.cols() - 1);
  add(result, rows);
  return result;
}

/// How far R^T R is from rows^T rows, each entry against the lengths of the two columns it belongs
/// to: Householder's backward error is small column by column, not only for the largest.
double gram_error(const MatrixXd& R, const MatrixXd& rows) {
  const VectorXd lengths = rows.colwise().norm();
  const MatrixXd error = R.transpose() * R - rows.transpose() * rows;
  double worst = 0.0;
  for (Index i = 0; i < error.rows(); ++i) {
    for (Index j = 0; j < error.cols(); ++j) {
      const double here =
          scaled(std::abs(error(i, j)), lengths[i] * lengths[j], rows.rows() + rows.cols());
      if (!(here <= worst)) worst = here;  // a NaN is the worst
    }
  }
  return worst;
}

bool is_upper_triangle(const MatrixXd& R) {
  return MatrixXd(R.triangularView<Eigen::StrictlyLower>()).isZero(0.0);
}

/// Every row with the sign that makes its diagonal entry positive.
MatrixXd with_positive_diagonal(MatrixXd R) {
  for (Index i = 0; i < R.rows(); ++i) {
    if (R(i, i) < 0.0) R.row(i) *= -1.0;
  }
  return R;
}

RC_GTEST_PROP(FastTriangle, HasTheSumOfSquaresOfItsRows, ()) {
  const Index columns = *rc::gen::inRange<Index>(1, 14);
  Triangle triangle(columns - 1);
  MatrixXd all(0, columns);
  const int blocks = *rc::gen::inRange(1, 5);
  for (int i = 0; i < blocks; ++i) {
    const MatrixXd rows = arbitrary_rows(columns, 40);
    add(triangle, rows);
    all = reference::stacked(all, rows);
  }
  RC_ASSERT(is_upper_triangle(triangle.R()));
  RC_ASSERT(gram_error(triangle.R(), all) < few_hundred_eps);
  RC_ASSERT(gram_error(reference::triangle(all), all) < few_hundred_eps);
}

// R itself is compared where it is well determined: its error is that of the rows times their
// condition.
RC_GTEST_PROP(FastTriangle, IsTheReferencesUpToSigns, ()) {
  const Index columns = *rc::gen::inRange<Index>(1, 12);
  const Index rows = 3 * columns;
  MatrixXd all(rows, columns);
  all.reshaped() = *test::vector(rows * columns, 1.0);
  all.diagonal().array() += 3.0;  // full rank, also after shrinking
  const VectorXd sizes = all.bdcSvd().singularValues();
  const double condition = sizes[0] / sizes[columns - 1];
  const Index first = *rc::gen::inRange<Index>(0, rows);
  Triangle triangle(columns - 1);
  add(triangle, all.topRows(first));
  add(triangle, all.bottomRows(rows - first));

  const MatrixXd R = with_positive_diagonal(triangle.R());
  const MatrixXd expected = with_positive_diagonal(reference::triangle(all));
  RC_ASSERT(scaled((R - expected).norm(), condition * expected.norm(), rows) < few_hundred_eps);
}

RC_GTEST_PROP(FastTriangle, MergesInAnyOrder, ()) {
  const Index columns = *rc::gen::inRange<Index>(1, 14);
  const MatrixXd a = arbitrary_rows(columns, 30), b = arbitrary_rows(columns, 30),
                 c = arbitrary_rows(columns, 30);
  const MatrixXd all = reference::stacked(reference::stacked(a, b), c);

  Triangle left = triangle_of(a);  // (a b) c
  left.merge(triangle_of(b));
  left.merge(triangle_of(c));
  Triangle bc = triangle_of(b);  // a (b c)
  bc.merge(triangle_of(c));
  Triangle right = triangle_of(a);
  right.merge(bc);
  Triangle backward = triangle_of(c);  // (c b) a
  backward.merge(triangle_of(b));
  backward.merge(triangle_of(a));
  for (const Triangle* merged : {&left, &right, &backward}) {
    RC_ASSERT(is_upper_triangle(merged->R()));
    RC_ASSERT(gram_error(merged->R(), all) < few_hundred_eps);
  }
}

RC_GTEST_PROP(FastTriangle, MergedWithItselfCountsTwice, ()) {
  const MatrixXd rows = arbitrary_rows(*rc::gen::inRange<Index>(1, 14), 40);
  Triangle triangle = triangle_of(rows);
  triangle.merge(triangle);
  RC_ASSERT(gram_error(triangle.R(), reference::stacked(rows, rows)) < few_hundred_eps);
}

RC_GTEST_PROP(FastTriangle, NothingAddedNothingChanged, ()) {
  const MatrixXd rows = arbitrary_rows(*rc::gen::inRange<Index>(1, 14), 40);
  Triangle triangle = triangle_of(rows);
  const MatrixXd before = triangle.R();
  add(triangle, MatrixXd(0, rows.cols()));
  add(triangle, MatrixXd::Zero(20, rows.cols()));
  triangle.merge(Triangle(rows.cols() - 1));
  RC_ASSERT(triangle.R() == before);
}

RC_GTEST_PROP(FastTriangle, ClearedIsAsNew, ()) {
  const Index columns = *rc::gen::inRange<Index>(1, 14);
  const MatrixXd first = arbitrary_rows(columns, 40), second = arbitrary_rows(columns, 40);
  Triangle triangle = triangle_of(first);
  triangle.clear();
  RC_ASSERT(triangle.R().isZero(0.0));
  add(triangle, second);
  RC_ASSERT(triangle.R() == triangle_of(second).R());
}

// A long log, row block by row block: errors do not pile up with the number of updates beyond what
// the number of rows explains.
TEST(FastTriangle, ManyUpdatesStayAccurate) {
  constexpr Index columns = 11, rows = 18, blocks = 3000;
  const MatrixXd all = MatrixXd::Random(rows * blocks, columns);
  Triangle triangle(columns - 1);
  for (Index i = 0; i < blocks; ++i) add(triangle, all.middleRows(rows * i, rows));
  EXPECT_LT(gram_error(triangle.R(), all), few_hundred_eps);
}

// A column so small that its squares are no full doubles is left out, and so spoils no other.
TEST(FastTriangle, ATinyColumnSpoilsNoOther) {
  MatrixXd rows = MatrixXd::Random(20, 5);
  rows.col(0) *= 1e-161;
  const MatrixXd R = triangle_of(rows).R();
  EXPECT_LT(gram_error(R.rightCols(4), rows.rightCols(4)), few_hundred_eps);
}

TEST(FastTriangle, NotFiniteUntilCleared) {
  Triangle triangle(1);
  triangle.add(MatrixXd::Constant(1, 1, std::nan("")), VectorXd::Ones(1));
  EXPECT_FALSE(triangle.R().allFinite());
  triangle.clear();
  triangle.add(MatrixXd::Constant(1, 1, 3.0), VectorXd::Constant(1, 4.0));
  EXPECT_TRUE(triangle.R().allFinite());
}

#ifndef NDEBUG
TEST(FastTriangleDeathTest, OtherSizesEndTheProgram) {
  Triangle triangle(3);
  EXPECT_DEATH(triangle.add(MatrixXd::Ones(2, 4), VectorXd::Ones(2)), "each unknown");
  EXPECT_DEATH(triangle.add(MatrixXd::Ones(2, 3), VectorXd::Ones(3)), "differ in rows");
  EXPECT_DEATH(triangle.merge(Triangle(2)), "different unknowns");
}
#endif

}  // namespace
}  // namespace shapeid
