#include "shapeid/tests/support/svd.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <limits>

namespace shapeid::test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd singular_values(const MatrixXd& A) {
  return Eigen::JacobiSVD<MatrixXd>(A).singularValues();
}

ThinSvd::ThinSvd(const MatrixXd& A) {
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  U = svd.matrixU();
  V = svd.matrixV();
  sigma = svd.singularValues();
}

Index ThinSvd::rank() const {
  if (sigma.size() == 0) return 0;
  const double rounding = std::max(
      static_cast<double>(sigma.size()) * std::numeric_limits<double>::epsilon() * sigma[0],
      std::numeric_limits<double>::min());
  return (sigma.array() >= rounding).count();
}

MatrixXd ThinSvd::solve(const MatrixXd& b) const {
  const Index r = rank();
  return V.leftCols(r) * sigma.head(r).cwiseInverse().asDiagonal() *
         (U.leftCols(r).transpose() * b);
}

}  // namespace shapeid::test
