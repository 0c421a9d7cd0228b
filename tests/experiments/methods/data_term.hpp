// The data term of one link's window, and the lower bounds that duality gives for it.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/inertia.hpp"

namespace shapeid::experiments {

using Matrix10 = Eigen::Matrix<double, 10, 10>;

/// f(Phi) = || Y Phi - F ||^2 of a window with one free link, compressed:
/// || R Phi - c ||^2 + constant. Every method minimises this same f over its own set of parameters.
/// lambda = 0.
class DataTerm {
 public:
  /// The triangle [R c] over [0 d], 11 x 11, of fast::Window or reference::triangle.
  explicit DataTerm(const Eigen::MatrixXd& triangle);

  [[nodiscard]] const Matrix10& R() const { return R_; }
  [[nodiscard]] const Vector10& c() const { return c_; }
  [[nodiscard]] double constant() const { return constant_; }

  [[nodiscard]] double value(const Vector10& Phi) const;
  /// || F ||^2, which tells what is a rounding of f.
  [[nodiscard]] double size() const { return constant_ + c_.squaredNorm(); }
  [[nodiscard]] Vector10 gradient(const Vector10& Phi) const;
  /// Where f is least without any condition.
  [[nodiscard]] Vector10 free_optimum() const;

  /// The minimum over all of R^10 of f(Phi) - z . Phi. If z . Phi >= 0 for every Phi of a set (z is
  /// in the dual of its cone), f is nowhere on the set below this, however z was found.
  [[nodiscard]] double dual(const Vector10& z) const;

 private:
  Matrix10 R_;
  Vector10 c_;
  double constant_;
};

}  // namespace shapeid::experiments
