#include "shapeid/tests/support/relaxations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace shapeid::test {
namespace {

using Matrix10 = Eigen::Matrix<double, 10, 10>;

/// Sigma of the body in units of `length`: the same cone, entries of one scale.
Eigen::Matrix4d in_units_of(double length, const Eigen::Matrix4d& sigma) {
  const Eigen::Vector4d unit(length, length, length, 1.0);
  return unit.asDiagonal() * sigma * unit.asDiagonal();
}

/// L of Sigma = L L^T from the ten entries of its lower triangle, row by row.
Eigen::Matrix4d lower_triangle(const Vector10& entries) {
  Eigen::Matrix4d L = Eigen::Matrix4d::Zero();
  for (int row = 0, k = 0; row < 4; ++row) {
    for (int col = 0; col <= row; ++col) L(row, col) = entries[k++];
  }
  return L;
}

struct Factored {
  Eigen::MatrixXd Y;  // W^(1/2) Y
  Eigen::VectorXd F;
  double length;

  [[nodiscard]] Vector10 Phi(const Vector10& entries) const {
    const Eigen::Matrix4d L = lower_triangle(entries);
    return from_pseudo_inertia(in_units_of(length, L * L.transpose())).values;
  }

  /// dPhi / d entries
  [[nodiscard]] Matrix10 slope(const Vector10& entries) const {
    const Eigen::Matrix4d L = lower_triangle(entries);
    Matrix10 slope;
    for (int k = 0; k < 10; ++k) {
      const Eigen::Matrix4d dL = lower_triangle(Vector10::Unit(k));
      slope.col(k) =
          from_pseudo_inertia(in_units_of(length, dL * L.transpose() + L * dL.transpose())).values;
    }
    return slope;
  }

  [[nodiscard]] double value(const Vector10& Phi) const { return (Y * Phi - F).squaredNorm(); }

  /// f - f* is at most <G, Sigma> - <G, Sigma*> by convexity, with G the gradient with respect to
  /// Sigma. <G, Sigma*> is at least min(0, lowest eigenvalue of G) times the trace of Sigma*, and
  /// that trace is bounded because f(Sigma*) <= f(Sigma) keeps Sigma* in an ellipsoid about the
  /// unconstrained minimum.
  [[nodiscard]] double gap(const Vector10& at) const {
    const Vector10 g = 2.0 * Y.transpose() * (Y * at - F);
    Eigen::Matrix4d G = Eigen::Matrix4d::Zero();
    Vector10 trace = Vector10::Zero();  // trace of Sigma = trace . Phi
    for (int row = 0; row < 4; ++row) {
      for (int col = 0; col < 4; ++col) {
        Eigen::Matrix4d unit = Eigen::Matrix4d::Zero();
        unit(row, col) = 0.5;
        unit += unit.transpose().eval();
        G(row, col) = g.dot(from_pseudo_inertia(in_units_of(length, unit)).values);
      }
    }
    for (int j = 0; j < 10; ++j) {
      const Eigen::Matrix4d sigma =
          in_units_of(1.0 / length, pseudo_inertia({Vector10(Vector10::Unit(j))}));
      trace[j] = sigma.trace();
    }
    const Eigen::VectorXd free = Y.householderQr().solve(F);
    const Matrix10 normal = Y.transpose() * Y;
    const double radius = std::sqrt(std::max(value(at) - value(free), 0.0));
    const double most_trace =
        trace.dot(free) + radius * std::sqrt(trace.dot(normal.ldlt().solve(trace)));
    const double lowest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(G).eigenvalues()[0];
    return g.dot(at) - most_trace * std::min(0.0, lowest);
  }
};

Factored weighted(const MassProblem& problem, double length) {
  const Eigen::VectorXd root = problem.W.cwiseSqrt();
  return {root.asDiagonal() * problem.Y, root.cwiseProduct(problem.F), length};
}

}  // namespace

double optimum_over_masses(const MassProblem& problem) {
  const Factored rows = weighted(problem, 1.0);
  Vector10 Phi = rows.Y.colPivHouseholderQr().solve(rows.F);
  if (Phi[0] < 0.0) {  // then the minimum lies on mass = 0
    Phi[0] = 0.0;
    Phi.tail<9>() = rows.Y.rightCols<9>().colPivHouseholderQr().solve(rows.F);
  }
  return rows.value(Phi);
}

ConsistentOptimum optimum_over_bodies(const MassProblem& problem, double length) {
  const Factored rows = weighted(problem, length);
  Vector10 entries;
  entries << 1, 0, 1, 0, 0, 1, 0, 0, 0, 1;  // 1 kg, one length wide: strictly inside the cone
  double damping = 1.0, value = rows.value(rows.Phi(entries));
  // Quadratic near the optimum; on the edge of the cone columns of L vanish slowly.
  constexpr int most_steps = 3000;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::MatrixXd J = rows.Y * rows.slope(entries);
    const Vector10 gradient = J.transpose() * (rows.Y * rows.Phi(entries) - rows.F);
    Matrix10 H = J.transpose() * J;
    H.diagonal().array() += damping * H.trace();
    const Vector10 next = entries - H.ldlt().solve(gradient);
    const double next_value = rows.value(rows.Phi(next));
    if (next_value <= value) {
      entries = next;
      value = next_value;
      damping = std::max(0.2 * damping, 1e-15);
    } else {
      damping *= 4.0;
    }
    if (damping > 1e6) break;  // no step lowers f any more
  }
  const Vector10 Phi = rows.Phi(entries);
  return {{Phi}, value - rows.gap(Phi), value};
}

}  // namespace shapeid::test
