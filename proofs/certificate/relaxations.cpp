#include "shapeid/proofs/certificate/relaxations.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/proofs/certificate/consistency.hpp"
#include "shapeid/proofs/certificate/exact_problem.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/proofs/certificate/optimum.hpp"

namespace shapeid::certificate {
namespace {

bool within_mass_bound(const ExactProblem& p, const Vector& Phi) {
  Rational total;
  for (std::size_t i = 0; i < Phi.size(); i += 10) total += Phi[i];
  return !p.mass_bound || total <= *p.mass_bound;
}

/// The parameters as columns of their own: masses >= 0, the rest free. What remains is solved
/// exactly.
Interval least_over_masses(const StatedProblem& stated, const Guess& guess) {
  if (guess.parameters.size() == 0) return {};
  const MassProblem& p = stated.masses;
  const Eigen::Index n = p.Y.cols(), k = stated.others.values.cols();
  StatedProblem open;
  open.masses.Y.resize(p.Y.rows(), 0);
  open.masses.U.resize(0, 0);
  open.masses.F = p.F;
  open.masses.W = p.W;
  open.others.values.resize(p.Y.rows(), n + k);
  open.others.values.leftCols(n) = p.Y;
  open.others.lower = Eigen::VectorXd::Constant(n + k, -HUGE_VAL);
  open.others.upper = Eigen::VectorXd::Constant(n + k, HUGE_VAL);
  for (Eigen::Index i = 0; i < n; i += 10) open.others.lower[i] = 0.0;
  Start start{{}, Eigen::VectorXd(n + k)};
  start.x.head(n) = guess.parameters;
  if (k > 0) {
    open.others.values.rightCols(k) = stated.others.values;
    open.others.lower.tail(k) = stated.others.lower;
    open.others.upper.tail(k) = stated.others.upper;
    start.x.tail(k) = guess.others;
  }
  const auto optimum = prove_optimum(open, start);
  if (!optimum) return {};
  Vector Phi;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) Phi.push_back(optimum->x.at(i));
  if (!within_mass_bound(ExactProblem(stated), Phi)) return {optimum->value, std::nullopt};
  return {optimum->value, optimum->value};
}

/// The data term of the guess, if that is made of bodies that can exist and keeps all bounds.
std::optional<Rational> reached_by_bodies(const ExactProblem& p, const Guess& guess) {
  const Vector Phi = exact(guess.parameters), x = exact(guess.others);
  for (std::size_t i = 0; i < Phi.size(); i += 10) {
    const auto at = Phi.begin() + static_cast<std::ptrdiff_t>(i);
    if (existence(Vector(at, at + 10)) == Existence::impossible) return std::nullopt;
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    if ((p.lower[k] && x[k] < *p.lower[k]) || (p.upper[k] && x[k] > *p.upper[k])) {
      return std::nullopt;
    }
  }
  if (!within_mass_bound(p, Phi)) return std::nullopt;
  return p.data_term(p.residual(Phi, x));
}

Interval least_over_bodies(const StatedProblem& stated, const Guess& guess) {
  if (guess.parameters.size() == 0) return {};
  const auto lower = floor_of_bodies(stated, guess.parameters, guess.others);
  return {lower ? *lower : Rational(0), reached_by_bodies(ExactProblem(stated), guess)};
}

/// What is below the least over the larger set is below the least over the smaller one, and what
/// the smaller one reaches the larger one reaches.
void carry_over(Interval& larger, Interval& smaller) {
  smaller.lower = std::max(smaller.lower, larger.lower);
  if (smaller.upper && (!larger.upper || *smaller.upper < *larger.upper)) {
    larger.upper = smaller.upper;
  }
}

/// Whether shapes as written have no negative mass, and no more than is counted where the mass is
/// bounded: else they may be in none of the larger sets.
bool shapes_have_the_mass_counted(const MassProblem& p) {
  for (Eigen::Index j = 0; j < p.U.cols(); ++j) {
    Rational mass;
    for (Eigen::Index i = 0; i < p.U.rows(); i += 10) {
      if (p.U(i, j) < 0.0) return false;
      mass += exact(p.U(i, j));
    }
    if (p.mass_bound > 0.0 && mass > 1) return false;
  }
  return true;
}

}  // namespace

Relaxations relaxations(const StatedProblem& stated, const Evidence& evidence, Interval shapes) {
  Relaxations of{least_over_masses(stated, evidence.masses),
                 least_over_bodies(stated, evidence.bodies),
                 {},
                 std::move(shapes)};
  if (evidence.limit.parameters.size() > 0) {
    const auto floor = floor_of_divisions(stated, evidence.limit.parameters, evidence.limit.others);
    if (floor) of.divisions.lower = *floor;
  }
  if (!shapes_have_the_mass_counted(stated.masses)) return of;
  carry_over(of.masses, of.bodies);
  carry_over(of.bodies, of.divisions);
  carry_over(of.divisions, of.shapes);
  carry_over(of.bodies, of.divisions);
  carry_over(of.masses, of.bodies);
  return of;
}

}  // namespace shapeid::certificate
