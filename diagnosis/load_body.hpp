// The body that a load can be: what of ten free numbers points of mass near its link explain.
#pragma once

#include <Eigen/Core>

#include <optional>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::diagnosis {

struct LoadBody {
  Eigen::VectorXd Phi;  ///< 10: kg, kg m, kg m^2
  double gain = 0.0;    ///< squared error that it takes away
  double lost = 0.0;    ///< squared error that ten free numbers take away, and it does not
};

/// How little a body may lose to be one: what lies below either.
struct MostLost {
  double error = 0.0;  ///< squared
  double share = 0.0;  ///< of what ten free numbers take away

  [[nodiscard]] bool allows(const LoadBody& body) const;
};

/// Of a load that is fitted beside all else: masses m >= 0 at points of the room, found as
/// load_places.hpp says. The best, or the first on the way to it that loses no more than `enough`.
[[nodiscard]] LoadBody best_body(const BlockFits::Beside& load, const Box& room,
                                 const std::optional<MostLost>& enough = {});

/// Empty if these are the normal equations of a load: of ten numbers.
[[nodiscard]] Violation why_no_load(const BlockFits::Beside& load);

}  // namespace shapeid::diagnosis
