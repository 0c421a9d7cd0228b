// From a simulated motion through sensors, a log file and the filter to rows and an answer: the way
// that a real robot's data go.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid::test {

/// Writes what the sensors read, with the noise of robot.yaml or without.
void write_log(const std::string& path, const Quadruped& quadruped,
               const std::vector<SimulatedSample>& motion, bool noise, std::uint64_t seed);

/// What is filtered at which cutoff, Hz. Nothing where there is none.
struct Cutoffs {
  std::optional<double> signals, rows;
};

/// The base's parameters from a log, of the samples up to `seconds`, with the default density term.
/// Every fifth sample is used (of the filtered rows if rows are filtered): at 500 Hz and the
/// cutoffs in question its neighbours say the same.
[[nodiscard]] InertialParameters fit_base(const std::string& log, const Quadruped& quadruped,
                                          const Cutoffs& cutoffs, double seconds);

/// How far the base is from the truth, in the units of each group.
struct BaseError {
  double mass = 0.0;          ///< kg
  double first_moment = 0.0;  ///< kg m, norm
  double tensor = 0.0;        ///< kg m^2, Frobenius norm, about the base origin
  double principal = 0.0;     ///< largest relative error of a principal inertia about the centre
};
[[nodiscard]] BaseError base_error(const Quadruped& quadruped, const InertialParameters& found);

/// Root mean square of each entry.
[[nodiscard]] BaseError rms(const std::vector<BaseError>& errors);

}  // namespace shapeid::test
