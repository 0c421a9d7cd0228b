// Logs read into memory, for what has to look at them more than once.
#pragma once

#include <optional>
#include <string>

#include "shapeid/app/inputs.hpp"
#include "shapeid/diagnosis/recording.hpp"

namespace shapeid::app {

struct RecordedLog {
  diagnosis::Recording recording;
  MotionReport motion;
  reference::ContactTreatment contacts;
};

/// The log, or one part of it.
[[nodiscard]] RecordedLog read_recording(const std::string& path, const RobotInputs& robot,
                                         const MotionInputs& inputs, std::optional<Part> wanted);

}  // namespace shapeid::app
