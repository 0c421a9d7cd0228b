#include "shapeid/app/recordings.hpp"

#include <utility>
#include <vector>

namespace shapeid::app {

RecordedLog read_recording(const std::string& path, const RobotInputs& robot,
                           const MotionInputs& inputs, std::optional<Part> wanted) {
  LogSamples log(path, robot, inputs);
  std::vector<Sample> samples;
  std::optional<double> start;
  while (std::optional<Sample> sample = log.next()) {
    if (!start) start = sample->time;
    if (!wanted || part_of(sample->time - *start) == *wanted) samples.push_back(*sample);
  }
  const MotionReport& report = log.report();
  return {diagnosis::Recording(std::move(samples), report.rate, report.extra), report,
          log.contacts()};
}

}  // namespace shapeid::app
