// A small trotting controller: enough of a real one that its logs look like a robot's.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/simbody/leg.hpp"
#include "shapeid/models/simbody/robot_state.hpp"

namespace shapeid {

/// What the robot is asked to do. Two sinusoids per quantity, of random phase and of frequencies
/// that the gait does not share, vary the motion so that a log excites the base's parameters.
struct TrotOptions {
  double stand = 0.4;       ///< s on four feet before the first step
  double period = 0.4;      ///< s, of a full cycle
  double duty = 0.55;       ///< share of the cycle that a foot is on the ground
  double clearance = 0.05;  ///< m, of a swinging foot

  double height = 0.29;       ///< m, base origin above the feet
  double speed = 0.25;        ///< m/s forward
  double vary_speed = 0.25;   ///< m/s, amplitude
  double vary_side = 0.1;     ///< m/s
  double vary_turn = 0.4;     ///< rad/s
  double vary_height = 0.02;  ///< m
  double vary_tilt = 0.08;    ///< rad, roll and pitch each

  double friction = 0.5;  ///< what the controller relies on; the ground may have more
};

/// Joint torques from the state of the robot. Stance: a wrench on the base by PD on height,
/// attitude and velocity, shared among the standing feet by least squares within friction, sent to
/// the joints by J^T. Swing: PD of the foot about a smooth arc to the place that Raibert's rule
/// gives. It reads the true base pose and velocity (a real robot has an estimate of them), and it
/// knows the robot's mass without any load.
class TrotController {
 public:
  /// Throws InputError unless the robot has four point contacts on legs of three joints each, one
  /// at each corner. The robot must outlive the controller.
  TrotController(const Robot& robot, const TrotOptions& options, std::uint64_t seed);

  /// Joint positions in which the robot stands.
  [[nodiscard]] const Eigen::VectorXd& stance() const { return stance_; }

  /// N m (n), within the joints' effort limits. To be called with growing time (s).
  [[nodiscard]] Eigen::VectorXd torque(double time, const RobotState& state);

 private:
  struct Wave {
    std::array<double, 2> frequency, phase;  // rad/s, rad
    [[nodiscard]] double operator()(double time) const;
  };
  struct Foot {
    Leg leg;
    Eigen::Vector3d home;  // below the hip, base axes
    double offset;         // of its cycle, as a share of the period
    bool standing = true;
    Eigen::Vector3d lifted = Eigen::Vector3d::Zero();  // world, where the present swing began
  };
  struct Wanted {
    Eigen::Vector3d velocity;  // world
    double turn, height, roll, pitch;
  };

  /// Joint positions with every foot at its home.
  void stand_up();
  [[nodiscard]] Wanted wanted(double time, double yaw) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> stance_forces(const RobotState& state,
                                                           const Wanted& wanted) const;
  [[nodiscard]] Eigen::Vector3d swing_force(const Foot& foot, double progress, double remaining,
                                            const RobotState& state, const Wanted& wanted) const;

  const Robot* robot_;
  TrotOptions options_;
  double mass_ = 0.0;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< of mass, standing, base axes
  std::vector<Foot> feet_;
  Eigen::VectorXd stance_;
  std::array<Wave, 6> waves_;
  double heading_ = 0.0;  // rad, integrated from the wanted turn
  double last_time_ = 0.0;
};

}  // namespace shapeid
