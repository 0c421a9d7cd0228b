#include "shapeid/models/differences.hpp"

namespace shapeid {

Eigen::VectorXd first_derivative(const Stencil& f, double rate) {
  return (rate / 12.0) * (8.0 * (f[3] - f[1]) - (f[4] - f[0]));
}

Eigen::VectorXd second_derivative(const Stencil& f, double rate) {
  return (rate * rate / 12.0) * (16.0 * (f[1] + f[3]) - 30.0 * f[2] - (f[0] + f[4]));
}

}  // namespace shapeid
