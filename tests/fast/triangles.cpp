#include "shapeid/tests/fast/triangles.hpp"

#include <rapidcheck.h>

#include <cmath>

#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::Triangle;

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

}  // namespace shapeid::test
