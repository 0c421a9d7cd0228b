// The logs of a diagnosis: which are fitted, and the same behind other filters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/diagnosis_run.hpp"
#include "shapeid/app/recordings.hpp"

namespace shapeid::app {

[[nodiscard]] std::vector<std::string> fitted_logs(const DiagnoseOptions& options);

/// Held-out errors are of data that were used for nothing else: throws InputError. `mapping`: that
/// of the logs.
void refuse_same_logs(const DiagnoseOptions& options, const std::optional<Mapping>& mapping);

/// The logs of a diagnosis in memory, none of which is refused by what holds before anything is
/// sought.
struct DiagnosedLogs {
  RecordedLog fitted, test;
  RecordedLog raw;                     ///< the test logs without any filter
  std::optional<RecordedLog> earlier;  ///< --reference
};
/// Reads them. Throws InputError and Refusal.
[[nodiscard]] DiagnosedLogs read_logs(const RobotInputs& robot, const DiagnoseOptions& options);

/// Throws Refusal if nothing is left to test on, for clocks that drift apart in one of them, and
/// for a test log whose columns are not what they are called.
void check_logs(const RobotInputs& robot, const DiagnoseOptions& options, const DiagnosedLogs& logs,
                const diagnosis::LoopSettings& settings);

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

  /// Hz: three times the cutoff, if the rate allows.
  [[nodiscard]] double less_smooth_cutoff() const;
  /// Behind that, from which the filter's own error is computed; none if there is no filter, or one
  /// that works forward only.
  [[nodiscard]] std::optional<RecordedLog> less_smooth() const;
  /// Behind diagnosis::slower_by times the cutoff; none if there is no filter.
  [[nodiscard]] std::optional<RecordedLog> smoother() const;
};

/// Of what is fitted, and of --reference if it is given.
[[nodiscard]] SameLogs same_fitted(const RobotInputs& robot, const DiagnoseOptions& options,
                                   const RecordedLog& fitted);
[[nodiscard]] std::optional<SameLogs> same_earlier(const RobotInputs& robot,
                                                   const DiagnoseOptions& options,
                                                   const std::optional<RecordedLog>& earlier);

}  // namespace shapeid::app
