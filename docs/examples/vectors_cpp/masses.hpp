// The mass problem: minimise over m >= 0  |W^(1/2) (Y U m - F)|^2 + lambda sum m_j^2 / V_j.
#pragma once

#include <Eigen/QR>

#include <algorithm>
#include <vector>

#include "json.hpp"

namespace example {

/// The density term as rows of its own: B = [W^(1/2) Y U; (lambda / V)^(1/2)], c = [W^(1/2) F; 0].
struct MassProblem {
  Eigen::MatrixXd B, U;
  Eigen::VectorXd c;
  double mass_bound = 0.0;

  [[nodiscard]] double objective(const Eigen::VectorXd& m) const {
    return (B * m - c).squaredNorm();
  }
};

inline MassProblem mass_problem(const Eigen::MatrixXd& Y, const Eigen::VectorXd& F,
                                const Eigen::VectorXd& W, const Eigen::MatrixXd& U,
                                const Eigen::VectorXd& V, double lambda) {
  MassProblem p;
  const Eigen::VectorXd roots = W.cwiseSqrt();
  p.U = U;
  p.B.resize(Y.rows() + V.size(), V.size());
  p.B.topRows(Y.rows()) = roots.asDiagonal() * Y * U;
  p.B.bottomRows(V.size()) = (lambda * V.cwiseInverse()).cwiseSqrt().asDiagonal();
  p.c = Eigen::VectorXd::Zero(p.B.rows());
  p.c.head(Y.rows()) = roots.cwiseProduct(F);
  return p;
}

inline MassProblem mass_problem(const Json& given) {
  MassProblem p = mass_problem(given["Y"].matrix(), given["F"].numbers(), given["W"].numbers(),
                               given["U"].matrix(), given["V"].numbers(), given["lambda"].number());
  p.mass_bound = given["mass_bound"].number();
  return p;
}

/// Lawson and Hanson. Stops when no slope is above rounding, or none of them helps.
inline Eigen::VectorXd minimiser(const MassProblem& p) {
  Eigen::VectorXd m = Eigen::VectorXd::Zero(p.B.cols());
  std::vector<Eigen::Index> free;
  while (true) {
    const double before = p.objective(m);
    const Eigen::VectorXd before_m = m;
    Eigen::VectorXd slopes = p.B.transpose() * (p.c - p.B * m);
    for (Eigen::Index j = 0; j < slopes.size(); ++j) slopes[j] /= p.B.col(j).norm();
    for (const Eigen::Index j : free) slopes[j] = 0.0;
    Eigen::Index steepest = 0;
    constexpr double rounding = 1e-15;
    if (!(slopes.maxCoeff(&steepest) > rounding * p.c.norm())) return m;
    free.push_back(steepest);
    while (!free.empty()) {
      const Eigen::MatrixXd columns = p.B(Eigen::all, free);
      const Eigen::VectorXd target = columns.colPivHouseholderQr().solve(p.c), at = m(free);
      double step = 1.0;
      Eigen::Index blocking = -1;
      for (Eigen::Index i = 0; i < target.size(); ++i) {
        const double until = target[i] > 0.0 ? 2.0 : at[i] / (at[i] - target[i]);
        if (until <= step) step = until, blocking = free[static_cast<std::size_t>(i)];
      }
      m(free) = at + step * (target - at);
      if (blocking < 0) break;
      m[blocking] = 0.0;
      free.erase(
          std::remove_if(free.begin(), free.end(), [&](Eigen::Index j) { return !(m[j] > 0.0); }),
          free.end());
    }
    if (!(p.objective(m) < before)) return before_m;
  }
}

}  // namespace example
