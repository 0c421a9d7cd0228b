// A simulated robot, its drives, the ground and what disturbs it, as one system that steps through
// time. Includes Simbody: for the sources of this folder alone.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/simbody/disturbance.hpp"
#include "shapeid/models/simbody/forces.hpp"
#include "shapeid/models/simbody/multibody.hpp"
#include "shapeid/models/simbody/simulation.hpp"

namespace shapeid {

class World {
 public:
  /// The robot must outlive the world. `accuracy` of the integrator, relative.
  World(const Robot& robot, const Ground& ground, const Disturbance& disturbance, double accuracy);

  /// From here, with these torques (N m, n) from `time` (s) on.
  void start(double time, const RobotState& robot_state, const Eigen::VectorXd& torque);
  /// Torques go straight to `command` until the instant `to` (s), and the world moves there.
  void advance(double to, const Eigen::VectorXd& command);

  [[nodiscard]] double now() const { return integrator_.getTime(); }
  [[nodiscard]] RobotState robot_state() const { return multibody_.get(integrator_.getState()); }
  /// N m (n), of the drives now.
  [[nodiscard]] Eigen::VectorXd torque() const { return drives_->torque(now()); }
  [[nodiscard]] SimulatedSample sample() const;

 private:
  void realize() { multibody_.system.realize(integrator_.getState(), SimTK::Stage::Acceleration); }

  const Robot& robot_;
  Multibody multibody_;
  DriveForce* drives_;
  GroundForce* ground_;
  SimTK::Force::Custom drive_handle_, ground_handle_, disturbance_handle_;
  SimTK::RungeKuttaMersonIntegrator integrator_;
};

}  // namespace shapeid
