#include "shapeid/tests/experiments/methods/cone.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace shapeid::experiments {
namespace {

/// 1 kg that is spread evenly over a ball, one length wide.
Vector10 round_body(double length) {
  return from_centre(1.0, Eigen::Vector3d::Zero(),
                     0.1 * length * length * Eigen::Matrix3d::Identity())
      .values;
}

Eigen::MatrixXd scaled(const Eigen::MatrixXd& A, const Eigen::VectorXd& unit) {
  return unit.asDiagonal() * A * unit.asDiagonal();
}

/// One barrier problem: f - mu log det A(Phi).
class Barrier {
 public:
  Barrier(const Cone& cone, const DataTerm& f) : cone_(cone), f_(f) {}

  struct Centre {
    Vector10 newton;    ///< the last step, which was not taken
    bool near = false;  ///< it would lower f + barrier by next to nothing
  };

  /// Newton steps from Phi, which is inside, until f + barrier falls no more than by a share of mu.
  Centre centre(double mu, Vector10& Phi) const {
    constexpr int most_steps = 50;
    constexpr double shortest = 1e-10;
    constexpr double small_decrease = 1e-3;  // of mu, the scale on which the barrier bends
    Centre end{Vector10::Zero()};
    for (int step = 0; step < most_steps; ++step) {
      // With X = L L^T and B_i = L^-1 A_i L^-T the Hessian is 2 R^T R + mu B^T B and the gradient
      // 2 R^T r - mu B^T vec(1): Newton's step is a least-squares problem, which QR solves without
      // squaring its condition.
      const Eigen::LLT<Eigen::MatrixXd> X(cone_.matrix(Phi));
      const Eigen::Index n = X.rows(), rows = 10 + n * n;
      Eigen::MatrixXd J(rows, 10);
      Eigen::VectorXd right(rows);
      J.topRows<10>() = std::sqrt(2.0) * f_.R();
      right.head<10>() = std::sqrt(2.0) * (f_.c() - f_.R() * Phi);
      for (Eigen::Index i = 0; i < 10; ++i) {
        const Eigen::MatrixXd half = X.matrixL().solve(cone_.A[static_cast<std::size_t>(i)]);
        const Eigen::MatrixXd B = X.matrixL().solve(half.transpose());
        J.col(i).tail(n * n) = std::sqrt(mu) * B.reshaped();
      }
      right.tail(n * n) = std::sqrt(mu) * Eigen::MatrixXd::Identity(n, n).reshaped();
      end.newton = J.colPivHouseholderQr().solve(right);
      const double decrease = (J * end.newton).squaredNorm();
      end.near = decrease <= small_decrease * mu;
      if (end.near) return end;
      double share = 1.0;
      const double before = value(mu, Phi), worth_it = 0.1 * decrease;
      while (!(value(mu, Phi + share * end.newton) <= before - share * worth_it)) {
        share *= 0.5;
        if (share < shortest) return end;  // rounding: f + barrier falls no further
      }
      Phi += share * end.newton;
    }
    return end;
  }

  /// z with z . Phi = <Z, A(Phi)>, which is not negative where A(Phi) is semidefinite if Z is. Z =
  /// mu (X^-1 - X^-1 dX X^-1) with Newton's dX is the multiplier of which f at the next step is the
  /// minimum; it is definite if the step is short in the barrier's own metric, as near says.
  [[nodiscard]] Vector10 dual_point(double mu, const Vector10& Phi, const Vector10& newton) const {
    const Eigen::MatrixXd inverse = cone_.matrix(Phi).inverse();
    const Eigen::MatrixXd Z = mu * (inverse - inverse * cone_.matrix(newton) * inverse);
    Vector10 z;
    for (Eigen::Index i = 0; i < 10; ++i) {
      z[i] = cone_.A[static_cast<std::size_t>(i)].cwiseProduct(Z).sum();
    }
    return z;
  }

 private:
  /// Infinite outside the set.
  [[nodiscard]] double value(double mu, const Vector10& Phi) const {
    const Eigen::LLT<Eigen::MatrixXd> factor(cone_.matrix(Phi));
    if (factor.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    return f_.value(Phi) - 2.0 * mu * factor.matrixLLT().diagonal().array().log().sum();
  }

  const Cone& cone_;
  const DataTerm& f_;
};

}  // namespace

Eigen::MatrixXd Cone::matrix(const Vector10& Phi) const {
  Eigen::MatrixXd sum = Phi[0] * A[0];
  for (Eigen::Index i = 1; i < 10; ++i) sum += Phi[i] * A[static_cast<std::size_t>(i)];
  return sum;
}

Cone consistent_bodies(double length) {
  Cone cone{{}, round_body(length)};
  const Eigen::Vector4d unit(1.0 / length, 1.0 / length, 1.0 / length, 1.0);
  for (Eigen::Index i = 0; i < 10; ++i) {
    cone.A.push_back(scaled(pseudo_inertia({Vector10(Vector10::Unit(i))}), unit));
  }
  return cone;
}

Cone positive_bodies(double length) {
  Cone cone{{}, round_body(length)};
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(6);
  unit.head<3>().setConstant(1.0 / length);
  for (Eigen::Index i = 0; i < 10; ++i) {
    const InertialParameters body{Vector10(Vector10::Unit(i))};
    const Eigen::Vector3d h = body.first_moment();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6, 6);
    A.topLeftCorner<3, 3>() = body.tensor();
    A.topRightCorner<3, 3>() << 0.0, -h.z(), h.y(), h.z(), 0.0, -h.x(), -h.y(), h.x(), 0.0;
    A.bottomLeftCorner<3, 3>() = A.topRightCorner<3, 3>().transpose().eval();
    A.bottomRightCorner<3, 3>() = body.mass() * Eigen::Matrix3d::Identity();
    cone.A.push_back(scaled(A, unit));
  }
  return cone;
}

ConeOptimum least_over(const Cone& cone, const DataTerm& f) {
  // From where the barrier and the data weigh alike down to where the gap, mu times the matrix's
  // order, is nothing beside || F ||^2 and its rounding. Each mu starts near its own optimum.
  constexpr double first = 1e-2, fall = 0.1;
  constexpr int most_falls = 11;  // down to 1e-13
  const Barrier barrier(cone, f);
  ConeOptimum best{cone.inside, 0.0, -std::numeric_limits<double>::infinity()};
  double mu = first * f.size();
  for (int k = 0; k <= most_falls; ++k, mu *= fall) {
    const Barrier::Centre centre = barrier.centre(mu, best.Phi);
    if (!centre.near) break;
    best.floor = std::max(best.floor, f.dual(barrier.dual_point(mu, best.Phi, centre.newton)));
  }
  best.value = f.value(best.Phi);
  return best;
}

}  // namespace shapeid::experiments
