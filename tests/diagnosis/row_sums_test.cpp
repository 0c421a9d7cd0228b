// Sums of products of columns.
#include "shapeid/diagnosis/row_sums.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <vector>

namespace shapeid::diagnosis {
namespace {

constexpr Eigen::Index columns = 7, most_at_once = 3;

/// Rows of few patterns of zeros, so that many are alike, and of any pattern.
Eigen::RowVectorXd any_row(const std::vector<int>& patterns) {
  const int pattern = *rc::gen::weightedOneOf<int>(
      {{4, rc::gen::elementOf(patterns)}, {1, rc::gen::inRange(0, 1 << columns)}});
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    if ((pattern >> c) % 2 == 1) row[c] = *rc::gen::inRange(-1000, 1000) / 128.0;
  }
  return row;
}

/// More than are summed at once, so that some are summed before the end.
RC_GTEST_PROP(RowSums, AreThoseOfAllProductsSinceTheLastTime, ()) {
  RowSums sums(columns, most_at_once);
  for (int time = 0; time < 2; ++time) {
    const auto patterns =
        *rc::gen::container<std::vector<int>>(2, rc::gen::inRange(0, 1 << columns));
    Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(columns, columns);
    for (int times = *rc::gen::inRange(0, 30); times > 0; --times) {
      Eigen::MatrixXd rows(*rc::gen::inRange<Eigen::Index>(0, most_at_once + 1), columns);
      for (Eigen::Index r = 0; r < rows.rows(); ++r) rows.row(r) = any_row(patterns);
      for (Eigen::Index r = 0; r < rows.rows(); ++r) {
        for (Eigen::Index i = 0; i < columns; ++i) {
          for (Eigen::Index j = 0; j < columns; ++j) wanted(i, j) += rows(r, i) * rows(r, j);
        }
      }
      sums.add(rows);
    }
    // Entries of 2^-7 and no more than 8: their products, and sums of a hundred, are exact.
    RC_ASSERT(sums.finish() == wanted);
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
