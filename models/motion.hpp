// From a log to samples: the same filter over every channel, derivatives, gaps, contacts.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/log.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid {

enum class Smoothing {
  none,        ///< values as logged; derivatives by central differences
  zero_phase,  ///< Butterworth forward and backward, for logs
  causal       ///< Butterworth forward only, for streams; its group delay is in the report
};

struct MotionOptions {
  Smoothing smoothing = Smoothing::zero_phase;
  double cutoff = 20.0;  ///< Hz, -3 dB of one pass; the same for joints, IMU and torque
  int order = 2;         ///< of one pass
  double rate = 0.0;     ///< Hz of the regular grid; 0: the log's median rate
  double gap = 5.0;      ///< a step longer than this many median steps is a gap
  /// Columns q/dq/ddq present in the log and trusted: with `exact_derivatives` logged dq, ddq and
  /// base.gyrodot are used as they are (simulation), else derivatives come from the filter.
  bool exact_derivatives = false;
  bool derive_contacts =
      false;  ///< from -J^-T (tau - given model) when the log has no contact columns
};

/// What preparing a log did, for the report of a run.
struct MotionReport {
  std::size_t rows = 0, samples = 0, gaps = 0, dropped_rows = 0;
  double rate = 0.0;         ///< Hz
  double group_delay = 0.0;  ///< s, at low frequency; 0 for zero_phase
  bool floating = false;     ///< the log has base.* columns
  bool contacts_logged = false, contacts_derived = false, forces_logged = false;
  std::vector<std::string> extra;  ///< columns that are neither ours nor mapped
  std::vector<std::string> notes;
};

/// Streams the samples of a log in fixed memory (chunks with overlap). Throws InputError for bad
/// input: a clock that runs backwards, units that cannot be (degrees), torque that is a current,
/// missing columns.
class MotionReader {
 public:
  /// `robot` must outlive the reader; its order of joints and contacts is the samples' order.
  MotionReader(const std::string& path, const Robot& robot, const RobotNotes& notes,
               const std::optional<Mapping>& mapping, const MotionOptions& options);
  ~MotionReader();
  MotionReader(MotionReader&&) noexcept;
  MotionReader& operator=(MotionReader&&) noexcept;
  MotionReader(const MotionReader&) = delete;
  MotionReader& operator=(const MotionReader&) = delete;

  [[nodiscard]] std::optional<Sample> next();
  /// Complete once next() has returned empty.
  [[nodiscard]] const MotionReport& report() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shapeid
