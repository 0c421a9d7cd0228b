#include "shapeid/proofs/certificate/floor.hpp"

#include <algorithm>
#include <vector>

#include "shapeid/proofs/certificate/bound.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"

namespace shapeid::certificate {
namespace {

bool every_link_has_a_region(const StatedProblem& p) {
  std::vector<bool> has(static_cast<std::size_t>(p.masses.U.rows() / 10), false);
  for (const Region& region : p.regions) has[static_cast<std::size_t>(region.link)] = true;
  return std::find(has.begin(), has.end(), false) == has.end();
}

/// What a unit point mass on this link costs, half the slope.
Quadric cost_on_link(const Vector& g, std::size_t link) {
  const auto at = g.begin() + static_cast<std::ptrdiff_t>(10 * link);
  return cost_of_point(Vector(at, at + 10));
}

/// Half the slope that a kilogram has at least, if places cost `low` at least: zero, or less.
Rational lowest_of(const Slopes& s, Rational low) {
  for (const Rational& a : s.a) low = std::min(low, a);
  return low;
}

struct Residual {
  Vector r;
  Slopes slopes;
};

Residual residual_at(const ExactProblem& p, const Eigen::VectorXd& Phi, const Eigen::VectorXd& x) {
  const Vector exact_Phi = exact(Phi);
  Vector r = p.residual(exact_Phi, settled_columns(p, exact_Phi, exact(x)));
  Slopes s = slopes(p, r);
  return {std::move(r), std::move(s)};
}

/// The bound of the residual t r, t >= 0, is -t^2 rWr + t h: its best t costs nothing to find.
std::optional<Rational> best_multiple(const ExactProblem& p, const Residual& at,
                                      const Rational& low) {
  if (sgn(low) < 0 && !p.mass_bound) return std::nullopt;
  const auto others = least_of_others(p, at.slopes.c);
  if (!others) return std::nullopt;
  Rational h = *others - 2 * dot(products(p.W, at.r), p.F);
  if (sgn(low) < 0) h += 2 * *p.mass_bound * low;
  const Rational square = p.data_term(at.r);
  return sgn(h) > 0 && sgn(square) > 0 ? Rational(h * h / (4 * square)) : Rational(0);
}

}  // namespace

std::optional<Rational> floor_of_divisions(const StatedProblem& stated, const Eigen::VectorXd& Phi,
                                           const Eigen::VectorXd& x) {
  if (!every_link_has_a_region(stated)) return std::nullopt;
  const ExactProblem p(stated);
  const Residual at = residual_at(p, Phi, x);
  Rational low;
  for (const Region& region : stated.regions) {
    const Quadric cost = cost_on_link(at.slopes.g, static_cast<std::size_t>(region.link));
    low = std::min(low, lowest_in(cost, region.shape).value);
  }
  return best_multiple(p, at, lowest_of(at.slopes, low));
}

std::optional<Rational> floor_of_bodies(const StatedProblem& stated, const Eigen::VectorXd& Phi,
                                        const Eigen::VectorXd& x) {
  const ExactProblem p(stated);
  const Residual at = residual_at(p, Phi, x);
  Rational low;
  for (std::size_t link = 0; link < at.slopes.g.size() / 10; ++link) {
    const auto here = lowest_in_space(cost_on_link(at.slopes.g, link));
    if (!here) return std::nullopt;
    low = std::min(low, *here);
  }
  return best_multiple(p, at, lowest_of(at.slopes, low));
}

}  // namespace shapeid::certificate
