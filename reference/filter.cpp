#include "shapeid/reference/filter.hpp"

#include <stdexcept>

namespace shapeid::reference {

ParameterFilter::ParameterFilter(double alpha) : alpha_(alpha) {
  if (!(alpha > 0.0 && alpha <= 1.0)) throw std::invalid_argument("alpha must lie in (0, 1]");
}

const Eigen::VectorXd& ParameterFilter::update(const Eigen::VectorXd& Phi) {
  value_ = value_ ? Eigen::VectorXd(alpha_ * Phi + (1.0 - alpha_) * *value_) : Phi;  // (17)
  return *value_;
}

}  // namespace shapeid::reference
