#include "shapeid/proofs/certificate/bound.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {
namespace {

/// The minimum is at t_j = V_j max(0, -a_j - nu) / lambda, with nu >= 0 the multiplier of the sum.
/// Its terms are then -(V_j / lambda)(a_j^2 - nu^2) over the shapes with -a_j > nu.
Rational water_filled(const Vector& a, const Vector& V, const Rational& lambda,
                      const std::optional<Rational>& M) {
  std::vector<std::size_t> order(a.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return a[i] < a[j]; });

  Rational slope_volume, volume, squares, nu;
  for (const std::size_t j : order) {
    if (sgn(a[j]) >= 0 || -a[j] <= nu) break;
    slope_volume -= a[j] * V[j];
    volume += V[j];
    squares += a[j] * a[j] * V[j];
    if (M) nu = std::max<Rational>(0, (slope_volume - lambda * *M) / volume);
  }
  return (nu * nu * volume - squares) / lambda;
}

/// The combination of rows nearest to weighing the free links, found in doubles: what is proved
/// with it does not depend on how it was found.
std::optional<Vector> weighing_rows(const MassProblem& p) {
  Eigen::VectorXd total = Eigen::VectorXd::Zero(p.Y.cols());
  for (Eigen::Index i = 0; i < total.size(); i += 10) total[i] = 1.0;
  const Eigen::VectorXd d = p.Y.transpose().completeOrthogonalDecomposition().solve(total);
  if (!d.allFinite()) return std::nullopt;  // entries near the largest double overflow on the way
  return exact(d);
}

}  // namespace

std::optional<Rational> least_mass_terms(const Vector& a, const Vector& V, const Rational& lambda,
                                         const std::optional<Rational>& M) {
  if (a.empty()) return Rational(0);
  if (sgn(lambda) > 0) return water_filled(a, V, lambda, M);
  const Rational least = *std::min_element(a.begin(), a.end());
  if (sgn(least) >= 0) return Rational(0);
  if (!M) return std::nullopt;
  return Rational(2 * *M * least);
}

std::optional<Rational> least_of_others(const ExactProblem& p, const Vector& c) {
  Rational least;
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (sgn(c[k]) == 0) continue;
    const std::optional<Rational>& end = sgn(c[k]) > 0 ? p.lower[k] : p.upper[k];
    if (!end) return std::nullopt;
    least += 2 * c[k] * *end;
  }
  return least;
}

std::optional<Rational> lower_bound(const ExactProblem& p, const Vector& r,
                                    const std::optional<Rational>& M) {
  const Slopes s = slopes(p, r);
  const auto masses = least_mass_terms(s.a, p.V, p.lambda, M);
  const auto others = least_of_others(p, s.c);
  if (!masses || !others) return std::nullopt;
  Vector terms{*masses, *others};
  for (std::size_t i = 0; i < r.size(); ++i)
    terms.emplace_back(-p.W[i] * r[i] * (r[i] + 2 * p.F[i]));
  return sum(terms);
}

Vector settled_columns(const ExactProblem& p, const Vector& Phi, Vector x) {
  const auto endless = [&](std::size_t k, int slope) {
    return (slope > 0 && !p.lower[k]) || (slope < 0 && !p.upper[k]);
  };
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const bool inside = (!p.lower[k] || x[k] > *p.lower[k]) && (!p.upper[k] || x[k] < *p.upper[k]);
    if (inside && (!p.lower[k] || !p.upper[k])) moving.push_back(k);
  }
  std::vector<Vector> CtWC;
  for (std::size_t k = 0; k < x.size(); ++k) {
    Vector unit(x.size());
    unit[k] = 1;
    CtWC.push_back(p.C.transposed_times(products(p.W, p.C.times(unit))));
  }
  for (;;) {
    const Vector c = slopes(p, p.residual(Phi, x)).c;
    std::vector<Vector> gram;
    Vector right;
    for (const std::size_t k : moving) {
      gram.emplace_back();
      for (const std::size_t l : moving) gram.back().push_back(CtWC[k][l]);
      right.push_back(-c[k]);
    }
    const Vector step = solve(std::move(gram), std::move(right));
    for (std::size_t i = 0; i < moving.size(); ++i) x[moving[i]] += step[i];
    const Vector now = slopes(p, p.residual(Phi, x)).c;
    bool settled = true;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (!endless(k, sgn(now[k]))) continue;
      moving.push_back(k);
      settled = false;
    }
    if (settled) return x;
  }
}

MassBound mass_bound(const StatedProblem& stated, const ExactProblem& p, const Rational& upper) {
  if (p.mass_bound) return {p.mass_bound, true};
  // Other columns could compensate any mass; their problems declare a bound.
  if (p.others() > 0 || p.shapes() == 0 || p.F.empty()) return {};
  const auto found = weighing_rows(stated.masses);
  if (!found) return {};
  const Vector& d = *found;
  const Vector weighs = p.U.transposed_times(p.Y.transposed_times(d));
  const Rational share = *std::min_element(weighs.begin(), weighs.end());
  if (sgn(share) <= 0) return {};
  // share sum t <= d^T Y U t = d^T F + d^T r <= d^T F + |W^(-1/2) d| |W^(1/2) r|, the last <=
  // upper.
  Vector squares;
  for (std::size_t i = 0; i < d.size(); ++i) squares.emplace_back(d[i] * d[i] / p.W[i]);
  const Rational most = dot(d, p.F) + root_above(upper * sum(squares));
  // No mass at all has an objective above `upper` if this is negative: then nothing does not.
  return {std::max<Rational>(0, most) / share, false};
}

}  // namespace shapeid::certificate
