// Equation (17): first-order smoothing of the parameters from window to window.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace shapeid::reference {

/// Phi_bar_k = alpha Phi_k + (1 - alpha) Phi_bar_(k-1), started at the first Phi. A convex
/// combination of consistent parameters is consistent, since the cone of pseudo-inertias is convex.
/// The filtered parameters do not minimise any single window's objective: report objectives before
/// this filter.
class ParameterFilter {
 public:
  /// `alpha` in (0, 1]; 1 does not smooth. Throws std::invalid_argument otherwise.
  explicit ParameterFilter(double alpha);

  const Eigen::VectorXd& update(const Eigen::VectorXd& Phi);
  [[nodiscard]] const std::optional<Eigen::VectorXd>& value() const { return value_; }

 private:
  double alpha_;
  std::optional<Eigen::VectorXd> value_;
};

}  // namespace shapeid::reference
