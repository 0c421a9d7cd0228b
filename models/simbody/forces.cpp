#include "shapeid/models/simbody/forces.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid {

double WorkingForce::work(const SimTK::State& state) const {
  return multibody_.forces.getZ(state)[work_];
}

void WorkingForce::realizeTopology(SimTK::State& state) const {
  work_ = multibody_.forces.allocateZ(state, SimTK::Vector(1, 0.0));
}

void WorkingForce::realizeAcceleration(const SimTK::State& state) const {
  multibody_.forces.updZDot(state)[work_] = power(state);
}

GroundForce::GroundForce(const Multibody& multibody, const Robot& robot, const Ground& ground)
    : WorkingForce(multibody), contacts_(robot.contacts), ground_(ground) {
  ground_.foot_radius.resize(contacts_.size(), 0.0);
}

SimTK::Vec3 GroundForce::station(const SimTK::State& state, std::size_t contact) const {
  const Contact& c = contacts_[contact];
  const SimTK::Vec3 down(0.0, 0.0, -ground_.foot_radius[contact]);
  return to_vec3(c.frame.translation()) +
         multibody_.body(c.link).expressGroundVectorInBodyFrame(state, down);
}

SimTK::Vec3 GroundForce::force(const SimTK::State& state, std::size_t contact) const {
  SimTK::Vec3 place, velocity;
  multibody_.body(contacts_[contact].link)
      .findStationLocationAndVelocityInGround(state, station(state, contact), place, velocity);
  const double depth = -place[2];
  if (depth <= 0.0) return SimTK::Vec3(0.0);
  const double damped = std::max(0.0, 1.0 - ground_.dissipation * velocity[2]);
  const double normal = ground_.stiffness * depth * std::sqrt(depth) * damped;
  const double speed = std::sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1] +
                                 ground_.slip_speed * ground_.slip_speed);
  const double drag = -ground_.friction * normal / speed;
  return {drag * velocity[0], drag * velocity[1], normal};
}

void GroundForce::calcForce(const SimTK::State& state,
                            SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                            SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector&) const {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    multibody_.body(contacts_[i].link)
        .applyForceToBodyPoint(state, station(state, i), force(state, i), body_forces);
  }
}

double GroundForce::power(const SimTK::State& state) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const SimTK::Vec3 velocity =
        multibody_.body(contacts_[i].link).findStationVelocityInGround(state, station(state, i));
    sum += SimTK::dot(force(state, i), velocity);
  }
  return sum;
}

DriveForce::DriveForce(const Multibody& multibody)
    : WorkingForce(multibody),
      start_(Eigen::VectorXd::Zero(multibody.joint_count())),
      end_(Eigen::VectorXd::Zero(multibody.joint_count())) {}

void DriveForce::hold(const Eigen::VectorXd& torque) {
  start_ = torque;
  end_ = torque;
}

void DriveForce::ramp(double from, double to, const Eigen::VectorXd& command) {
  start_ = torque(from);
  end_ = command;
  from_ = from;
  to_ = to;
}

Eigen::VectorXd DriveForce::torque(double time) const {
  const double share = std::clamp((time - from_) / (to_ - from_), 0.0, 1.0);
  return (1.0 - share) * start_ + share * end_;
}

void DriveForce::calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>&,
                           SimTK::Vector_<SimTK::Vec3>&, SimTK::Vector& mobility_forces) const {
  const Eigen::VectorXd tau = torque(state.getTime());
  for (int j = 0; j < multibody_.joint_count(); ++j) {
    multibody_.body(j + 1).applyOneMobilityForce(state, 0, tau[j], mobility_forces);
  }
}

double DriveForce::power(const SimTK::State& state) const {
  const Eigen::VectorXd tau = torque(state.getTime());
  double sum = 0.0;
  for (int j = 0; j < multibody_.joint_count(); ++j) {
    sum += tau[j] * multibody_.body(j + 1).getOneU(state, 0);
  }
  return sum;
}

void DisturbingForce::calcForce(const SimTK::State& state,
                                SimTK::Vector_<SimTK::SpatialVec>& body_forces,
                                SimTK::Vector_<SimTK::Vec3>&,
                                SimTK::Vector& mobility_forces) const {
  if (!disturbance_) return;
  const int n = multibody_.joint_count();
  DisturbedState now;
  now.time = state.getTime();
  now.q.resize(n);
  now.dq.resize(n);
  now.drive = drives_.torque(now.time);
  for (int j = 0; j < n; ++j) {
    now.q[j] = multibody_.body(j + 1).getOneQ(state, 0);
    now.dq[j] = multibody_.body(j + 1).getOneU(state, 0);
  }
  for (int link = 0; link <= n; ++link) {
    now.attitude.push_back(to_eigen(multibody_.body(link).getBodyRotation(state)));
    now.velocity.push_back(to_eigen(multibody_.body(link).getBodyOriginVelocity(state)));
  }
  DisturbingForces forces{Eigen::VectorXd::Zero(n),
                          std::vector<Eigen::Vector3d>(now.velocity.size(), {0.0, 0.0, 0.0})};
  disturbance_(now, forces);
  for (int j = 0; j < n; ++j) {
    multibody_.body(j + 1).applyOneMobilityForce(state, 0, forces.joint[j], mobility_forces);
  }
  for (int link = 0; link <= n; ++link) {
    const SimTK::Vec3 force = to_vec3(forces.link[static_cast<std::size_t>(link)]);
    multibody_.body(link).applyForceToBodyPoint(state, SimTK::Vec3(0.0), force, body_forces);
  }
}

}  // namespace shapeid
