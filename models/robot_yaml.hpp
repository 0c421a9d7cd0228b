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
  std::map<std::string, double> noise_sigma;  ///< per channel of the log, in the channel's unit
  struct Rotor {
    double inertia = 0.0;  ///< kg m^2 about its spin axis, before the gear
    double gear = 1.0;
  };
  std::map<std::string, Rotor> rotors;  ///< per joint
  struct MassRange {
    double lower = 0.0, upper = 0.0;  ///< kg
  };
  std::map<std::string, MassRange> expected_mass;  ///< per free link, or "load"
  bool contacts_given = false;  ///< the robot's contacts are those of the file, if only none
};

/// Reads robot.yaml and puts its contacts into `robot` (replacing those there). Throws InputError.
[[nodiscard]] RobotNotes read_robot_yaml(const std::string& path, Robot& robot);

/// M0, kg: what these links weigh together, each by the middle of its range in robot.yaml, else by
/// the URDF. Zero if neither says anything.
[[nodiscard]] double expected_mass(const Robot& robot, const RobotNotes& notes,
                                   const std::vector<int>& links);

}  // namespace shapeid
