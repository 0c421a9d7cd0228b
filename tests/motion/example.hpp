// Robots and motions in closed form, and logs of them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/motion.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// A chain with joints "j0", "j1", ... about y, z, x, y, ... and links "base", "l0", "l1", ...
[[nodiscard]] Robot chain(int joints, Root root);

/// Sums of sines below 2 Hz with different phases in every quantity; consistent derivatives.
/// Torques are smooth, too. The accelerometer reads gravity and a little more.
[[nodiscard]] Sample smooth_motion(const Robot& robot, double time);

/// Column names of a whole log of the robot, in the order of log_row().
[[nodiscard]] std::vector<std::string> log_columns(const Robot& robot);
[[nodiscard]] std::vector<double> log_row(const Robot& robot, const Sample& sample);

/// Writes the motion at the given times.
void write_log(const std::string& path, const Robot& robot, const std::vector<double>& times,
               const std::function<Sample(double)>& motion);

/// count times from `start`, 1 / rate apart
[[nodiscard]] std::vector<double> regular_times(double start, double rate, int count);

struct ReadMotion {
  std::vector<Sample> samples;
  MotionReport report;
};
[[nodiscard]] ReadMotion read_motion(const std::string& path, const Robot& robot,
                                     const MotionOptions& options = {},
                                     const std::optional<Mapping>& mapping = {},
                                     const RobotNotes& notes = {});

}  // namespace shapeid::test
