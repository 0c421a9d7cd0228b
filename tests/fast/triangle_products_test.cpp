// Products with the triangle of a window against dense ones.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>

#include "shapeid/fast/triangle_products.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::few_hundred_eps;
using test::scaled;

constexpr double unwritten = std::numeric_limits<double>::infinity();

/// Ten numbers a link, as far as the link reaches, apart from those of the next; nothing between
/// them or behind them is written, and no column that was not asked for.
RC_GTEST_PROP(TriangleProducts, ColumnsOfALinkAsDense, ()) {
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  const int links = *rc::gen::inRange(1, 6), link = *rc::gen::inRange(0, links);
  const int rank = *rc::gen::inRange(0, 11);
  const Index apart = *rc::gen::element<Index>(10, 13, 20);
  const Index size = Index{10} * links + 1;
  const MatrixXd R =
      MatrixXd::NullaryExpr(size, size, [&] { return draw.sign(); }).triangularView<Eigen::Upper>();
  TenRows E{};
  MatrixXd dense = MatrixXd::Zero(size - 1, rank);  // e_k in the entries of the link
  for (int k = 0; k < rank; ++k) {
    for (int i = 0; i < 10; ++i) {
      const double x = draw.sign();
      E[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] = x;
      dense(Index{10} * link + i, k) = x;
    }
  }
  MatrixXd made = MatrixXd::Constant(apart * links + 3, rank + 1, unwritten);
  link_columns(R, link, E, rank, apart, made.data(), made.rows());

  MatrixXd expected = MatrixXd::Constant(made.rows(), made.cols(), unwritten);
  const MatrixXd products = R.topLeftCorner(size - 1, size - 1) * dense;
  for (int b = 0; b <= link; ++b) {
    expected.block(apart * b, 0, 10, rank) = products.middleRows(Index{10} * b, 10);
  }
  for (Index i = 0; i < made.size(); ++i) {
    const double x = made.data()[i], y = expected.data()[i];
    const bool is_right = y == unwritten ? x == y : scaled(x - y, 10.0, 10) < few_hundred_eps;
    RC_ASSERT(is_right);
  }
}

}  // namespace
}  // namespace shapeid::fast
