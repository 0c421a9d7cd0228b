// How far from the truth an answer may be that leaves no more of its rows than it says.
#pragma once

#include <Eigen/Core>

namespace shapeid::test {

/// A bound on || x - truth || for an x with || A x - F ||^2 = left:
///   sigma_min(A) || x - truth || <= || A x - F || + || A truth - F ||.
[[nodiscard]] double farthest(const Eigen::MatrixXd& A, const Eigen::VectorXd& F,
                              const Eigen::VectorXd& truth, double left);

}  // namespace shapeid::test
