#include "shapeid/models/mass_problem.hpp"

#include <fmt/format.h>

#include <cmath>

namespace shapeid {
namespace {

Violation why_not_positive(const char* what, const Eigen::VectorXd& numbers) {
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    if (!(numbers[i] > 0.0)) return fmt::format("{} {} is {:g}, not positive", what, i, numbers[i]);
  }
  return std::nullopt;
}

}  // namespace

Violation why_malformed(const MassProblem& p) {
  if (p.Y.rows() != p.F.size() || p.F.size() != p.W.size()) {
    return fmt::format("rows disagree: Y {}, F {}, W {}", p.Y.rows(), p.F.size(), p.W.size());
  }
  if (p.Y.cols() != p.U.rows() || p.U.rows() % 10 != 0) {
    return fmt::format("Y has {} columns, U {} rows: both must be 10 for each free link",
                       p.Y.cols(), p.U.rows());
  }
  if (p.V.size() != p.U.cols()) {
    return fmt::format("{} volumes for {} shapes", p.V.size(), p.U.cols());
  }
  const bool finite =
      p.Y.allFinite() && p.F.allFinite() && p.W.allFinite() && p.U.allFinite() && p.V.allFinite();
  if (!finite) return "a number of the mass problem is not finite";
  if (Violation why = why_not_positive("weight", p.W)) return why;
  if (Violation why = why_not_positive("volume", p.V)) return why;
  if (!(p.lambda >= 0.0 && std::isfinite(p.lambda))) {
    return fmt::format("lambda is {:g}, must be finite and >= 0", p.lambda);
  }
  return std::nullopt;
}

Objective objective(const MassProblem& p, const Eigen::VectorXd& m) {
  const Eigen::VectorXd residual = p.Y * (p.U * m) - p.F;
  return {residual.dot(p.W.cwiseProduct(residual)),
          p.lambda * m.cwiseAbs2().cwiseQuotient(p.V).sum()};
}

Eigen::VectorXd gradient(const MassProblem& p, const Eigen::VectorXd& m) {
  const Eigen::VectorXd residual = p.Y * (p.U * m) - p.F;
  return 2.0 * (p.U.transpose() * (p.Y.transpose() * p.W.cwiseProduct(residual))) +
         2.0 * p.lambda * m.cwiseQuotient(p.V);
}

double default_lambda(const MassProblem& p, double expected_mass) {
  constexpr double share = 1e-12;
  return share * p.F.dot(p.W.cwiseProduct(p.F)) * p.V.sum() / (expected_mass * expected_mass);
}

}  // namespace shapeid
