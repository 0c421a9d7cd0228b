// What acts on the simulated robot besides gravity, as Simbody force elements that also keep the
// work they did. Includes Simbody: for the sources of this folder alone.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/simbody/disturbance.hpp"
#include "shapeid/models/simbody/ground.hpp"
#include "shapeid/models/simbody/multibody.hpp"

namespace shapeid {

/// A force element that integrates its power along with the motion, to the integrator's accuracy.
class WorkingForce : public SimTK::Force::Custom::Implementation {
 public:
  explicit WorkingForce(const Multibody& multibody) : multibody_(multibody) {}

  /// J since the start.
  [[nodiscard]] double work(const SimTK::State& state) const;

  void realizeTopology(SimTK::State& state) const override;
  void realizeAcceleration(const SimTK::State& state) const override;
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 protected:
  /// W, what the element now gives to the robot.
  [[nodiscard]] virtual double power(const SimTK::State& state) const = 0;

  const Multibody& multibody_;

 private:
  mutable SimTK::ZIndex work_;
};

/// The ground under the robot's contact points.
class GroundForce : public WorkingForce {
 public:
  GroundForce(const Multibody& multibody, const Robot& robot, const Ground& ground);

  /// N, world axes, on one contact point. Needs Stage::Velocity.
  [[nodiscard]] SimTK::Vec3 force(const SimTK::State& state, std::size_t contact) const;

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;

 protected:
  double power(const SimTK::State& state) const override;

 private:
  /// m, link axes: where the ground pushes.
  [[nodiscard]] SimTK::Vec3 station(const SimTK::State& state, std::size_t contact) const;

  std::vector<Contact> contacts_;
  Ground ground_;
};

/// The drives of the joints: torque follows a command as a straight line over one control period,
/// so that it is continuous in time and its sampled value is the one that acts.
class DriveForce : public WorkingForce {
 public:
  explicit DriveForce(const Multibody& multibody);

  /// These torques (N m, n) at all times, until there is a ramp.
  void hold(const Eigen::VectorXd& torque);
  /// From the torque at time `from` straight to `command` (N m, n) at time `to`. What acts at
  /// `from` stays as it is.
  void ramp(double from, double to, const Eigen::VectorXd& command);
  /// N m (n), at a time from the latest ramp's start on.
  [[nodiscard]] Eigen::VectorXd torque(double time) const;

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;

 protected:
  double power(const SimTK::State& state) const override;

 private:
  double from_ = 0.0, to_ = 1.0;
  Eigen::VectorXd start_, end_;
};

/// What disturbs the robot beyond its model.
class DisturbingForce : public SimTK::Force::Custom::Implementation {
 public:
  DisturbingForce(const Multibody& multibody, const DriveForce& drives,
                  const Disturbance& disturbance)
      : multibody_(multibody), drives_(drives), disturbance_(disturbance) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                 SimTK::Vector_<SimTK::Vec3>& particle_forces,
                 SimTK::Vector& mobility_forces) const override;
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0.0; }

 private:
  const Multibody& multibody_;
  const DriveForce& drives_;
  Disturbance disturbance_;
};

}  // namespace shapeid
