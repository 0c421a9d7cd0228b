#include "shapeid/models/stated_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shapeid {
namespace {

Violation why_misplaced(const std::vector<Region>& regions, const char* what,
                        const StatedProblem& p) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region& region = regions[i];
    if (region.link < 0 || 10 * region.link >= p.masses.U.rows()) {
      return fmt::format("{} {} is on free link {}, there are {}, counted from 0", what, i,
                         region.link, p.masses.U.rows() / 10);
    }
    if (const Violation why = why_malformed(region.shape)) {
      return fmt::format("{} {}: {}", what, i, *why);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Region> regions_of(const BodyModel& model) {
  std::vector<Region> regions;
  for (const SoughtShape& s : model.shapes) {
    const auto place = std::lower_bound(model.free_links.begin(), model.free_links.end(), s.link);
    regions.push_back({place - model.free_links.begin(), s.shape});
  }
  return regions;
}

Violation why_malformed(const StatedProblem& p) {
  if (Violation why = why_malformed(p.masses)) return why;
  if (!(p.masses.mass_bound >= 0.0 && std::isfinite(p.masses.mass_bound))) {
    return "the mass bound is negative or not finite";
  }
  const OtherColumns& C = p.others;
  if (C.lower.size() != C.values.cols() || C.upper.size() != C.values.cols()) {
    return fmt::format("{} columns, {} lower and {} upper bounds", C.values.cols(), C.lower.size(),
                       C.upper.size());
  }
  // No columns may be written as no rows at all.
  if (C.values.size() + C.values.rows() > 0 && C.values.rows() != p.masses.F.size()) {
    return fmt::format("columns have {} rows, F {}", C.values.rows(), p.masses.F.size());
  }
  if (!C.values.allFinite()) return "a number of the columns is not finite";
  for (Eigen::Index k = 0; k < C.lower.size(); ++k) {
    if (!(C.lower[k] <= C.upper[k]) || C.lower[k] == HUGE_VAL || C.upper[k] == -HUGE_VAL) {
      return fmt::format("column {} has no value between its bounds", k);
    }
  }
  if (Violation why = why_misplaced(p.regions, "region", p)) return why;
  if (Violation why = why_misplaced(p.shapes, "shape", p)) return why;
  if (!p.shapes.empty() && static_cast<Eigen::Index>(p.shapes.size()) != p.masses.shapes()) {
    return fmt::format("{} shapes are stated, U has {} columns", p.shapes.size(),
                       p.masses.shapes());
  }
  return std::nullopt;
}

}  // namespace shapeid
