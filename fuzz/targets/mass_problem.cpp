// Any mass problem: by the reference, by the fast path, and judged by the certificate. What is
// proved of one answer must hold of the other.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "shapeid/fast/solve_masses.hpp"
#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/declines.hpp"
#include "shapeid/fuzz/support/problems.hpp"
#include "shapeid/proofs/certificate/certify.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

using namespace shapeid;

namespace {

/// What both solvers promise of a gradient entry over its terms: the reference's are those of its
/// rows, the fast path's those of its triangle.
constexpr double promised_slope = 1e-10;

certificate::Proof proof_of(const MassProblem& p, const MassSolution& solution) {
  const StatedProblem stated{p, {}, {}};
  const Answer answer{problem_digest(stated), solution.m, solution.Phi, solution.value.total()};
  certificate::Proof proof = certificate::certify(stated, answer).proof;
  fuzz::check(proof.lower >= 0.0 && proof.lower <= proof.upper, "bounds come in order");
  fuzz::check(!proof.feasible || proof.lower <= proof.objective_above,
              "no answer is below what is proved of the optimum");
  return proof;
}

void check_masses(const MassSolution& solution) {
  fuzz::check(solution.m.allFinite() && !(solution.m.array() < 0.0).any(), "masses are masses");
  fuzz::check(std::isfinite(solution.value.total()), "an objective is a number");
}

/// The worst slope of `m` over what compressed rows tell of it: lengths of whole columns and of all
/// forces. A row of large force that says nothing of a shape still rounds what small rows say of
/// it.
double worst_compressed_slope(const MassProblem& p, const Eigen::VectorXd& m) {
  const Eigen::VectorXd root = p.W.cwiseSqrt();
  const Eigen::VectorXd columns = (root.asDiagonal() * p.Y).colwise().norm();
  const Eigen::MatrixXd U = p.U.cwiseAbs();
  const double forces = root.cwiseProduct(p.F).norm() + columns.dot(U * m);
  const Eigen::VectorXd terms =
      2.0 * forces * (U.transpose() * columns) + 2.0 * p.lambda * m.cwiseQuotient(p.V);
  const Eigen::VectorXd slopes = gradient(p, m);
  double worst = 0.0;
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    if (terms[j] == 0.0) continue;  // a shape that no row feels
    test::keep_worst(worst, (m[j] > 0.0 ? std::abs(slopes[j]) : -slopes[j]) / terms[j]);
  }
  return worst;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  // Eight decades are more than any robot's units make; thirty are for the sake of the exact
  // checker.
  const bool ordinary = bytes.flag();
  const MassProblem p = fuzz::any_problem(bytes, ordinary ? 4 : 15);
  const std::optional<MassSolution> fast = fast::solve_masses(p);
  if (fast) check_masses(*fast);
  if (ordinary) fuzz::declines.count(!fast);
  const MassSolution reference = reference::solve_masses(p);
  check_masses(reference);

  const certificate::Proof of_reference = proof_of(p, reference);
  if (!fast) return 0;
  const certificate::Proof of_fast = proof_of(p, *fast);
  // Each proof speaks of the one optimum, whoever's answer it started from.
  if (of_reference.feasible) {
    fuzz::check(of_fast.lower <= of_reference.objective_above,
                "proved bounds hold of the reference");
  }
  if (of_fast.feasible) {
    fuzz::check(of_reference.lower <= of_fast.objective_above,
                "proved bounds hold of the fast path");
  }
  if (!ordinary) return 0;
  fuzz::check(reference::kkt_residual(p, reference.m).worst() < promised_slope,
              "the reference's slopes are roundings");
  fuzz::check(worst_compressed_slope(p, fast->m) < promised_slope,
              "the fast path's slopes are roundings of compressed rows");
  const double terms =
      std::max(test::objective_terms(p, fast->m), test::objective_terms(p, reference.m));
  const double apart = std::abs(objective(p, fast->m).total() - objective(p, reference.m).total());
  fuzz::check(apart <= promised_slope * terms, "both find the same minimum");
  return 0;
}
