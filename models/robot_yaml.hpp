// robot.yaml, optional beside a URDF: what a URDF cannot say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid {

/// Pose of the IMU in the base link's frame, and more that the URDF does not hold.
struct RobotNotes {
  Eigen::Isometry3d imu = Eigen::Isometry3d::Identity();
  bool imu_given = false;
  std::map<std::string, double> noise_sigma;  ///< per channel of the log, in the channel's unit
  struct MassRange {
    double lower = 0.0, upper = 0.0;  ///< kg
  };
  std::map<std::string, MassRange> expected_mass;  ///< per free link, or "load"
  bool contacts_given = false;  ///< the file lists the contacts (possibly an empty list)
};

/// Reads robot.yaml and puts its contacts (replacing those there) and rotors into `robot`. Throws
/// InputError.
[[nodiscard]] RobotNotes read_robot_yaml(const std::string& path, Robot& robot);

/// M0, kg: what these links weigh together, each by the middle of its range in robot.yaml, else by
/// the URDF. Zero if neither says anything.
[[nodiscard]] double expected_mass(const Robot& robot, const RobotNotes& notes,
                                   const std::vector<int>& links);

}  // namespace shapeid
