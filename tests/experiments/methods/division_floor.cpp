#include "shapeid/tests/experiments/methods/division_floor.hpp"

#include <algorithm>
#include <limits>

#include "shapeid/tests/experiments/methods/lowest_point.hpp"
#include "shapeid/tests/experiments/methods/mass_columns.hpp"

namespace shapeid::experiments {
DivisionLimit limit_of_divisions(const BodyModel& regions, const DataTerm& f, double gap) {
  constexpr int most_rounds = 60;
  MassColumns columns(regions, most_rounds);
  DivisionLimit limit;
  limit.floor = -std::numeric_limits<double>::infinity();
  for (int round = 0; round < most_rounds; ++round) {
    limit.Phi = columns.solve(f);
    limit.value = f.value(limit.Phi);
    Vector10 z = f.gradient(limit.Phi);
    const LowestPoint lowest = lowest_point(regions, z);
    z[0] -= std::min(0.0, lowest.value);  // mass is 1 everywhere: now z . pi is nowhere below 0
    limit.floor = std::max(limit.floor, f.dual(z));
    const double left = limit.value - limit.floor;
    if (left <= std::max(gap * limit.value, nothing_beside_data * f.size())) break;
    columns.append(from_centre(1.0, lowest.point, Eigen::Matrix3d::Zero()).values);
  }
  return limit;
}

}  // namespace shapeid::experiments
