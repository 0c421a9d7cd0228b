#include "shapeid/models/student.hpp"

#include <unsupported/Eigen/SpecialFunctions>

#include <algorithm>
#include <cmath>

namespace shapeid {

double limit_for(double least_t, Eigen::Index blocks) {
  constexpr int halvings = 60;
  const double freedom = static_cast<double>(std::max<Eigen::Index>(blocks - 1, 1));
  const double probability = std::erfc(least_t / std::sqrt(2.0));
  // P(|t| > x) = I_y(freedom / 2, 1 / 2) with y = freedom / (freedom + x^2)
  double lower = 0.0, upper = 1e9;
  for (int i = 0; i < halvings; ++i) {
    const double x = 0.5 * (lower + upper);
    const double tail = Eigen::numext::betainc(0.5 * freedom, 0.5, freedom / (freedom + x * x));
    (tail > probability ? lower : upper) = x;
  }
  return upper;
}

}  // namespace shapeid
