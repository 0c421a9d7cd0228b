#include "shapeid/models/stated_problem.hpp"

#include <fmt/format.h>

#include <cmath>

namespace shapeid {

Violation why_malformed(const StatedProblem& p) {
  if (const Violation why = why_malformed(p.masses)) return why;
  if (!(p.masses.mass_bound >= 0.0)) return "the mass bound is negative";
  const OtherColumns& C = p.others;
  if (C.lower.size() != C.values.cols() || C.upper.size() != C.values.cols()) {
    return fmt::format("{} columns, {} lower and {} upper bounds", C.values.cols(), C.lower.size(),
                       C.upper.size());
  }
  if (C.values.cols() > 0 && C.values.rows() != p.masses.F.size()) {
    return fmt::format("columns have {} rows, F {}", C.values.rows(), p.masses.F.size());
  }
  if (!C.values.allFinite()) return "a number of the columns is not finite";
  for (Eigen::Index k = 0; k < C.lower.size(); ++k) {
    if (!(C.lower[k] <= C.upper[k]) || C.lower[k] == HUGE_VAL || C.upper[k] == -HUGE_VAL) {
      return fmt::format("column {} has no value between its bounds", k);
    }
  }
  for (const Region& region : p.regions) {
    if (region.link < 0 || 10 * region.link >= p.masses.U.rows()) {
      return fmt::format("a region is on free link {}, there are {}", region.link,
                         p.masses.U.rows() / 10);
    }
    if (const Violation why = why_malformed(region.shape)) return why;
  }
  return std::nullopt;
}

}  // namespace shapeid
