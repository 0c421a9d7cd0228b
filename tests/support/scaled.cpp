#include "shapeid/tests/support/scaled.hpp"

#include <algorithm>
#include <limits>

namespace shapeid::test {

double scaled(double error, double scale, Eigen::Index size) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  if (error == 0.0) return 0.0;
  return error / (scale * eps * static_cast<double>(std::max<Eigen::Index>(size, 1)));
}

double scaled_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::Index size) {
  return scaled((a - b).norm(), std::max(a.norm(), b.norm()), size);
}

}  // namespace shapeid::test
