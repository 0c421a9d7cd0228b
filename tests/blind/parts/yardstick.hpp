// What a model that is told the truth is worth, and from which size on an effect can be seen at
// all. Shares with the diagnosis the regressor, the filter and the effects' equations, but neither
// its fits nor its choices.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/tests/blind/parts/trial.hpp"

namespace shapeid::blind {

/// A log as the diagnosis reads it.
[[nodiscard]] diagnosis::Recording read_log(const Machine& machine, const std::string& path);

/// The catalogue's effect with the numbers that the item was put in with.
[[nodiscard]] diagnosis::AppliedEffect applied(const Machine& machine, const Item& item);

/// Generalised rows by which an item of unit size changes what is logged, dof x samples of
/// `clean`.usable(1), on the motion of the clean log; what is not in the catalogue is put in with
/// the item's own size, and that divided by it.
[[nodiscard]] Eigen::MatrixXd unit_change(const Machine& machine, const Item& item,
                                          const Readings& clean_readings,
                                          const diagnosis::Recording& clean,
                                          const std::string& scratch_folder,
                                          std::uint64_t noise_seed);

/// The smallest size from which on a model that knows the item lowers the blocked held-out error of
/// this log by three standard errors, masses refitted by both; to a log `without` the item, too, if
/// there is one. Infinity if there is no such size. `clean` has the noise of the log that the item
/// comes into: where this noise hides the item, more of it is needed.
[[nodiscard]] double detectable_size(const Machine& machine, const diagnosis::Recording& clean,
                                     const Eigen::MatrixXd& unit_change,
                                     const diagnosis::Recording* without = nullptr);

/// A model that is told the trial's effects and fits the masses to the log.
struct ToldTruth {
  /// Root of the sum over joints of the mean squared residual on the test log, N m.
  double error = 0.0;
  /// Of the free links, by a fit that is also told how far from the truth given inertias are as a
  /// rule (of many drawn as these were), and how much of the filtered noise is independent: what
  /// such a log says of inertias at best.
  std::vector<InertialParameters> inertias;
};
[[nodiscard]] ToldTruth told_truth(const Machine& machine, const Trial& trial,
                                   const diagnosis::Recording& log,
                                   const diagnosis::Recording& test);

}  // namespace shapeid::blind
