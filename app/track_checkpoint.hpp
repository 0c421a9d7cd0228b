// Where a run of `track` stands, as a file to go on from.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/track_run.hpp"

namespace shapeid::app {

/// How far the log was read.
struct LogPosition {
  std::string header;           ///< its first line
  std::uint64_t next_byte = 0;  ///< of the first line that is not used yet
  int line = 0;                 ///< number of the last line used
  std::uint64_t row_byte = 0;   ///< where the last line used begins
  std::string row_digest = {};  ///< of its text
};

/// Names everything besides the log that an answer depends on: robot, shapes, options. A run may
/// only be resumed with the same.
[[nodiscard]] std::string setup_digest(const RobotInputs& robot, const BodyModel& model,
                                       const TrackSettings& settings);

/// Writes beside `path` and renames: there is always a whole checkpoint. Throws InputError.
void write_checkpoint(const std::string& path, TrackRun& run, const LogPosition& position,
                      const std::string& setup);

struct Checkpoint {
  std::string path;
  nlohmann::json document;
  LogPosition position;
};

/// Throws InputError if something is at `path` that is no checkpoint of any version, and would be
/// written over.
void check_replaceable(const std::string& path);

/// Throws InputError for a file that is no checkpoint, or of another version.
[[nodiscard]] Checkpoint read_checkpoint(const std::string& path);

/// Puts `run`, which must be new, where the checkpoint was written. Throws InputError for one of
/// another setup.
void restore(const Checkpoint& checkpoint, TrackRun& run, const std::string& setup);

}  // namespace shapeid::app
