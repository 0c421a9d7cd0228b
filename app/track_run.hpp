// Rows of a log in, JSON lines out: what `shapeid track` does between reading and printing.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/app/track_estimates.hpp"
#include "shapeid/app/track_events.hpp"
#include "shapeid/app/track_repeats.hpp"
#include "shapeid/app/track_slip.hpp"
#include "shapeid/models/plausibility.hpp"
#include "shapeid/models/row_guard.hpp"
#include "shapeid/models/sample_stream.hpp"

namespace shapeid::app {

struct TrackSettings {
  EstimateSettings estimates;
  StreamOptions stream;
  double contact_threshold = 0.0;  ///< with which stream.derive_contacts was made
};

/// A robot that is followed. `log`, `robot` and `model` must outlive it.
class TrackRun {
 public:
  TrackRun(const LogTable& log, const RobotInputs& robot, const BodyModel& model,
           TrackSettings settings);

  /// Takes the next row and returns the lines that became due (docs/formats/track.md). Throws
  /// InputError for rows that cannot be read at all, and, in the first some thousand of them, for
  /// units and signs that cannot be (Plausibility).
  [[nodiscard]] std::vector<nlohmann::json> push(const LogRow& row);

  [[nodiscard]] std::size_t lines() const { return lines_; }
  [[nodiscard]] const TrackSettings& settings() const { return settings_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("meaning", meaning_);
    archive("guard", guard_);
    archive("repeats", repeats_);
    archive("stream", stream_);
    if (stream_.rate() > 0.0) {
      if (!estimates_) prepare();
      archive("estimates", *estimates_);
      archive("slip", *slip_);
    }
    archive("events", events_);
    archive("row_time", row_time_);
    archive("row_step", row_step_);
    archive("line_time", line_time_);
    archive("sample_time", sample_time_);
    archive("calm", calm_);
    archive("held_back", held_back_);
    archive("lines", lines_);
  }

  /// Why there was no line so far, for a log that has ended.
  [[nodiscard]] std::string why_no_line() const;
  /// Why the last line has no answer, where no line since this object was made has one.
  [[nodiscard]] const std::optional<std::string>& why_no_answer() const { return why_no_answer_; }
  /// Whether no answer so far explained anything, and the last is doubted.
  [[nodiscard]] bool never_found_mass() const;
  /// kg, of the last tenths of a second, where that, and all before, is too much for torques in N
  /// m.
  [[nodiscard]] std::optional<double> mass_out_of_scale() const;

 private:
  enum class Why { answered, still, no_samples, declined };

  void prepare();
  void watch_clock(MeasuredRow row);
  void watch_units(const MeasuredRow& row);
  void take(const GuardedRow& row);
  void take(const Sample& sample);
  [[nodiscard]] bool stands_still(const Sample& sample);
  void print(Why why, double time);
  [[nodiscard]] nlohmann::json links_json() const;
  [[nodiscard]] nlohmann::json mass_json() const;
  [[nodiscard]] nlohmann::json rows_json() const;
  [[nodiscard]] nlohmann::json samples_json() const;
  [[nodiscard]] nlohmann::json contacts_json() const;
  [[nodiscard]] std::string scale() const;

  const RobotInputs& robot_;
  const BodyModel& model_;
  TrackSettings settings_;
  RowMeaning meaning_;
  RowGuard guard_;
  SampleStream stream_;
  std::optional<Estimates> estimates_;  ///< once the rate is known
  std::optional<SlipWatch> slip_;
  TrackEvents events_;
  RepeatWatch repeats_;
  std::optional<double> row_time_;     ///< s, of the last row
  std::optional<double> row_step_;     ///< s, between the last two
  std::optional<double> line_time_;    ///< s, of the last line, or of the first row after a break
  std::optional<double> sample_time_;  ///< s, of the last sample
  std::size_t calm_ = 0;               ///< samples in a row in which nothing moves
  std::size_t held_back_ = 0;          ///< still samples since the last line
  std::size_t lines_ = 0;
  std::size_t rows_of_units_ = 0;  ///< that were looked at
  std::vector<nlohmann::json> due_;
  std::string path_;
  std::optional<std::string> why_no_answer_ = std::string();  ///< in no checkpoint
  bool was_in_scale_ = false;                                 ///< likewise
  std::optional<Plausibility> units_;  ///< of the first rows; in no checkpoint
};

}  // namespace shapeid::app
