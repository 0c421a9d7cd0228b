#include "shapeid/tests/fast/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::test {

using Eigen::Index;
using Eigen::VectorXd;

// At lambda = 0, with z the gradients of two answers,
//   2 || R (Phi1 - Phi2) ||^2 = (z1 - z2)^T (m1 - m2) <= rounding of z in (m1 + m2),
// because each answer has z >= 0 and z_j m_j = 0 to rounding of z's terms.
Agreement agreement(const TriangleCase& given, const fast::MassSolver& solver,
                    const VectorXd& reference) {
  const MassProblem& p = given.problem;
  const VectorXd m = solver.m();
  const Index size = p.F.size() + p.shapes();
  const VectorXd terms = gradient_terms(p, m).cwiseMax(gradient_terms(p, reference));
  Agreement here;
  here.kkt = reference::kkt_residual(p, m).worst();
  here.objective = scaled_objective_difference(p, m, reference);
  here.value = scaled(std::abs(solver.value().total() - objective(p, m).total()),
                      objective_terms(p, m), size);
  const VectorXd Phi = p.U * m;
  for (Index i = 0; i < Phi.size(); ++i) {
    const double term = p.U.row(i).cwiseAbs().dot(m);
    keep_worst(here.Phi, scaled(std::abs(solver.Phi()[i] - Phi[i]), term, p.shapes()));
  }
  here.motion =
      scaled((p.Y * (p.U * (m - reference))).squaredNorm(), terms.dot(m + reference), size);
  if (p.lambda > 0.0) {
    here.masses = scaled_mass_difference(p, m, reference);
    const VectorXd z = gradient(p, m);
    for (Index j = 0; j < p.shapes(); ++j) {
      if ((m[j] > 0.0) == (reference[j] > 0.0)) continue;
      ++here.other_side;
      keep_worst(here.other_slope, scaled(std::abs(0.5 * z[j]), terms[j], size));
    }
    const double total = reference.sum();
    if (here.other_side == 0 && total > 0.0) {
      here.largest_move = (m - reference).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / total;
    }
  }
  return here;
}

void keep_worst(const Agreement& one, Agreement& worst) {
  keep_worst(worst.kkt, one.kkt);
  keep_worst(worst.objective, one.objective);
  keep_worst(worst.value, one.value);
  keep_worst(worst.Phi, one.Phi);
  keep_worst(worst.masses, one.masses);
  keep_worst(worst.largest_move, one.largest_move);
  keep_worst(worst.motion, one.motion);
  keep_worst(worst.other_slope, one.other_slope);
}

std::string why_not_equal(const Agreement& here, const TriangleCase& given,
                          const fast::MassSolver& solver) {
  std::string text;
  const auto expect = [&](const char* what, double error, double bound) {
    if (!(error < bound)) text += fmt::format("{}: {:.3g}\n", what, error);  // a NaN is not below
  };
  expect("KKT residual", here.kkt, promised_slope);
  expect("objective", here.objective, few_hundred_eps);
  expect("value()", here.value, few_hundred_eps);
  expect("Phi()", here.Phi, few_hundred_eps);
  expect("masses", here.masses, few_hundred_eps);
  expect("a mass", here.largest_move, damped_rounding);
  expect("R Phi", here.motion, few_hundred_eps);
  expect("slope of a shape on the other side", here.other_slope, few_hundred_eps);
  if ((solver.m().array() < 0.0).any()) text += "a mass is negative\n";
  std::vector<bool> passive(static_cast<std::size_t>(solver.shapes()), false);
  for (const int j : solver.passive()) passive[static_cast<std::size_t>(j)] = true;
  for (int j = 0; j < solver.shapes(); ++j) {
    if (passive[static_cast<std::size_t>(j)] == (solver.m()[j] > 0.0)) continue;
    text += fmt::format("shape {} of mass {} is on the wrong list\n", j, solver.m()[j]);
  }
  const int most = 100 + 4 * (10 * given.link_count() + given.shapes());
  if (solver.iterations() > most) {
    text += fmt::format("{} steps, above {}\n", solver.iterations(), most);
  }
  return text;
}

void Tally::count(const Agreement& here, int iterations) {
  ++compared_;
  other_side_ += here.other_side;
  most_iterations_ = std::max(most_iterations_, iterations);
  keep_worst(here, worst_);
}

Tally::~Tally() {
  fmt::print(
      "{}: {} compared, {} declined; worst KKT {:.1e}; in roundings: objective {:.1g}, masses "
      "{:.1g}, R Phi {:.1g}; masses {:.1e} of the sum; {} shapes on the other side; at most {} "
      "steps\n",
      name_, compared_, declined_, worst_.kkt, worst_.objective, worst_.masses, worst_.motion,
      worst_.largest_move, other_side_, most_iterations_);
}

}  // namespace shapeid::test
