// Claim C8. Rows reduced to a triangle: the same sum of squares for every parameter vector.
#pragma once

#include <Eigen/Core>

namespace shapeid::reference {

/// R of the Householder QR of `rows`, at most as many rows as columns. || rows x || = || R x ||
/// for every x, so with rows = [Y F] and x = (Phi, -1) the data term of (15) is unchanged, and R of
/// stacked triangles is R of the stacked rows.
[[nodiscard]] Eigen::MatrixXd triangle(const Eigen::MatrixXd& rows);

/// One above the other; the column counts agree.
[[nodiscard]] Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

}  // namespace shapeid::reference
