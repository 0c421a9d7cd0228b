// fast::Triangle against the rows themselves and against reference::triangle.
#include "shapeid/fast/triangle.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <type_traits>
#include <utility>

#include "shapeid/models/contract.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/fast/triangles.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::Triangle;
using test::add;
using test::arbitrary_rows;
using test::few_hundred_eps;
using test::gram_error;
using test::scaled;
using test::triangle_of;

static_assert(
    noexcept(std::declval<Triangle&>().add(std::declval<const Eigen::Ref<const MatrixXd>&>(),
                                           std::declval<const Eigen::Ref<const VectorXd>&>())));
static_assert(noexcept(std::declval<Triangle&>().merge(std::declval<const Triangle&>())));
static_assert(noexcept(std::declval<Triangle&>().forget(0.5)));
static_assert(noexcept(std::declval<Triangle&>().clear()));

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
  const VectorXd sizes = test::singular_values(all);
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

// Columns enough that several reflections are made at once, and a last block of fewer.
RC_GTEST_PROP(FastTriangle, OfManyColumnsHasTheSumOfSquaresOfItsRows, ()) {
  const Index columns = *rc::gen::inRange<Index>(28, 60);
  const MatrixXd first = arbitrary_rows(columns, 90), second = arbitrary_rows(columns, 90);
  Triangle triangle = triangle_of(first);
  add(triangle, second);
  RC_ASSERT(is_upper_triangle(triangle.R()));
  RC_ASSERT(gram_error(triangle.R(), reference::stacked(first, second)) < few_hundred_eps);
  Triangle merged = triangle_of(second);
  merged.merge(triangle_of(first));
  RC_ASSERT(is_upper_triangle(merged.R()));
  RC_ASSERT(gram_error(merged.R(), reference::stacked(first, second)) < few_hundred_eps);
}

RC_GTEST_PROP(FastTriangle, AbsorbsRowsAsItAddsThem, ()) {
  MatrixXd rows = arbitrary_rows(*rc::gen::inRange<Index>(1, 40), 40);
  Triangle triangle(rows.cols() - 1);
  const MatrixXd before = rows;
  triangle.absorb(rows);
  RC_ASSERT(gram_error(triangle.R(), before) < few_hundred_eps);
}

RC_GTEST_PROP(FastTriangle, ForgetsByTheFactorSaid, ()) {
  const MatrixXd rows = arbitrary_rows(*rc::gen::inRange<Index>(1, 14), 40);
  const double factor = *test::real(0.0, 1.0);
  Triangle triangle = triangle_of(rows);
  triangle.forget(factor);
  RC_ASSERT(gram_error(triangle.R(), std::sqrt(factor) * rows) < few_hundred_eps);
}

RC_GTEST_PROP(FastTriangle, AssignedIsTheOther, ()) {
  const MatrixXd rows = arbitrary_rows(*rc::gen::inRange<Index>(1, 14), 40);
  Triangle triangle = triangle_of(2.0 * rows);
  triangle.assign(triangle_of(rows));
  RC_ASSERT(triangle.R() == triangle_of(rows).R());
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
  EXPECT_DEATH(triangle.forget(1.5), "between 0 and 1");
}
#endif

}  // namespace
}  // namespace shapeid
