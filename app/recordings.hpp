// Logs read into memory, for what has to look at them more than once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/diagnosis/recording.hpp"

namespace shapeid::app {

struct RecordedLog {
  diagnosis::Recording recording;
  MotionReport motion;
  ContactTreatment contacts;
  /// s: first and last time of the first log and the last, whatever part of them this is
  double begins = 0.0, ends = 0.0;
  std::vector<double> shifts = {};       ///< s that each of several logs was moved by
  std::vector<std::size_t> starts = {};  ///< samples at which further logs begin
};

/// The log, or one part of it.
[[nodiscard]] RecordedLog read_recording(const std::string& path, const RobotInputs& robot,
                                         const MotionInputs& inputs, std::optional<Part> wanted);

/// Throws InputError if contacts are logged in one of two logs only, and forces are not: what feet
/// are found to touch, and what is said to touch, leave residuals that cannot be compared.
struct ContactSource {
  std::string path;
  bool derived;
};
void check_contacts_alike(const ContactSource& first, const ContactSource& other,
                          ContactTreatment contacts);

/// Several logs of the same robot as one, a second's pause between them, or moved in time by
/// `shifts`, so that the same logs with another filter, or other parts of them, have the same
/// times. Throws InputError if their rates or extra columns differ, or if contacts are logged in
/// some only.
[[nodiscard]] RecordedLog read_recordings(const std::vector<std::string>& paths,
                                          const RobotInputs& robot, const MotionInputs& inputs,
                                          std::optional<Part> wanted,
                                          const std::vector<double>& shifts = {});

}  // namespace shapeid::app
