// What the simulated robot's sensors say: the columns and rows of a log.
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/simbody/random.hpp"

namespace shapeid {

struct SensorOptions {
  /// Gaussian noise of the sigmas that the robot's notes give: for a column by its own name
  /// (tau.FR_hip), else by its quantity (tau, base.gyro). What has no sigma is exact.
  bool noise = true;
  /// Adds base.gyrodot, ddq and the contact forces, which robots seldom have, without noise.
  bool exact_extras = false;
  std::uint64_t seed = 1;
};

/// Columns and rows of a log in the format of docs/formats. A floating robot has base.gyro and
/// base.accel at the IMU's pose in the IMU's axes (and base.gyrodot in the same axes), and the
/// base's attitude base.quat; forces are in base axes; tau is what the drives give, their rotors'
/// share included. Contact flags have no noise.
class Sensors {
 public:
  Sensors(const Robot& robot, const RobotNotes& notes, const SensorOptions& options);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// The next row, one number a column: noise is drawn in the order of the columns. `attitude`
  /// turns base axes into world axes; a fixed robot ignores it.
  [[nodiscard]] std::vector<double> measure(const Sample& sample,
                                            const Eigen::Quaterniond& attitude);

 private:
  void add(const std::string& column, const std::string& quantity);

  std::vector<std::string> columns_;
  std::vector<double> sigma_;  ///< a column
  RobotNotes notes_;
  Eigen::VectorXd rotor_inertias_;
  SensorOptions options_;
  bool floating_;
  Random random_;
};

}  // namespace shapeid
