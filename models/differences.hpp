// Central differences of fourth order on a regular grid.
#pragma once

#include <Eigen/Core>

#include <array>

namespace shapeid {

/// Rows needed before and after the one that is differentiated.
inline constexpr int difference_reach = 2;

/// Five successive rows around the wanted one.
using Stencil = std::array<Eigen::VectorXd, 2 * difference_reach + 1>;

/// `rate`: 1 / h. The error is h^4 / 30 times the fifth derivative.
[[nodiscard]] Eigen::VectorXd first_derivative(const Stencil& f, double rate);
/// The error is h^4 / 90 times the sixth derivative.
[[nodiscard]] Eigen::VectorXd second_derivative(const Stencil& f, double rate);

}  // namespace shapeid
