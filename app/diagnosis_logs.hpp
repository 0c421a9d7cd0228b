// The logs of a diagnosis: which are fitted, and the same behind other filters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/diagnosis_run.hpp"
#include "shapeid/app/recordings.hpp"

namespace shapeid::app {

[[nodiscard]] std::vector<std::string> fitted_logs(const DiagnoseOptions& options);

/// Held-out errors are of data that were used for nothing else: throws InputError.
void refuse_same_logs(const DiagnoseOptions& options);

/// Every how many samples of a log of this rate (Hz) count: five a period of the filter's cutoff
/// say all that is left in the signals.
[[nodiscard]] std::size_t stride_of(const MotionInputs& inputs, double rate);

/// s between blocks of a log of this rate (Hz).
[[nodiscard]] double margin_of(const MotionInputs& inputs, double rate);

/// Logs that are read once more with another filter: they have the same times.
struct SameLogs {
  const RobotInputs& robot;
  MotionInputs inputs;
  std::vector<std::string> paths;
  std::optional<Part> part;
  double rate;                 ///< Hz
  std::vector<double> shifts;  ///< RecordedLog::shifts

  /// Behind three times the cutoff, from which the filter's own error is computed; none if there is
  /// no filter, or one that works forward only.
  [[nodiscard]] std::optional<RecordedLog> less_smooth() const;
  /// Behind diagnosis::slower_by times the cutoff; none if there is no filter.
  [[nodiscard]] std::optional<RecordedLog> smoother() const;
};

}  // namespace shapeid::app
