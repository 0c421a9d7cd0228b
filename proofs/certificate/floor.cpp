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

struct LowestPlaces {
  Rational value;  ///< of all of them; zero: mass nowhere lowers the objective
  std::vector<Place> places;
};

LowestPlaces lowest_places(const StatedProblem& p, const Vector& g) {
  std::vector<std::optional<Lowest>> of_link(g.size() / 10);
  for (const Region& region : p.regions) {
    const auto at = static_cast<std::ptrdiff_t>(10 * region.link);
    const Quadric q = cost_of_point(Vector(g.begin() + at, g.begin() + at + 10));
    Lowest here = lowest_in(q, region.shape);
    std::optional<Lowest>& best = of_link[static_cast<std::size_t>(region.link)];
    if (sgn(here.value) < 0 && (!best || here.value < best->value)) best = std::move(here);
  }
  LowestPlaces lowest;
  for (std::size_t l = 0; l < of_link.size(); ++l) {
    if (!of_link[l]) continue;
    const Vector& x = of_link[l]->point;
    lowest.value = std::min(lowest.value, of_link[l]->value);
    lowest.places.push_back(
        {static_cast<Eigen::Index>(l), {x[0].get_d(), x[1].get_d(), x[2].get_d()}});
  }
  return lowest;
}

}  // namespace

std::optional<Floor> floor_of_divisions(const StatedProblem& stated, const Eigen::VectorXd& Phi,
                                        const Eigen::VectorXd& x) {
  if (!every_link_has_a_region(stated)) return std::nullopt;
  const ExactProblem p(stated);
  const Vector exact_Phi = exact(Phi);
  const Vector r = p.residual(exact_Phi, settled_columns(p, exact_Phi, exact(x)));
  const Slopes s = slopes(p, r);
  const LowestPlaces lowest = lowest_places(stated, s.g);
  if (sgn(lowest.value) < 0 && !p.mass_bound) return std::nullopt;
  const auto others = least_of_others(p, s.c);
  if (!others) return std::nullopt;

  // The bound of the residual t r, t >= 0, is -t^2 rWr + t h: its best t costs nothing to find.
  Rational h = *others - 2 * dot(products(p.W, r), p.F);
  if (sgn(lowest.value) < 0) h += 2 * *p.mass_bound * lowest.value;
  const Rational square = p.data_term(r);
  Floor floor{0, lowest.places};
  if (sgn(h) > 0 && sgn(square) > 0) floor.value = h * h / (4 * square);
  return floor;
}

}  // namespace shapeid::certificate
