#include "shapeid/tests/app/farthest.hpp"

#include <cmath>

#include "shapeid/tests/support/svd.hpp"

namespace shapeid::test {

double farthest(const Eigen::MatrixXd& A, const Eigen::VectorXd& F, const Eigen::VectorXd& truth,
                double left) {
  return (std::sqrt(left) + (A * truth - F).norm()) / singular_values(A).tail<1>()[0];
}

}  // namespace shapeid::test
