#include "shapeid/models/simbody/world.hpp"

namespace shapeid {

World::World(const Robot& robot, const Ground& ground, const Disturbance& disturbance,
             double accuracy)
    : robot_(robot),
      multibody_(robot),
      drives_(new DriveForce(multibody_)),
      ground_(new GroundForce(multibody_, robot, ground)),
      // The force subsystem owns the elements from here on.
      drive_handle_(multibody_.forces, drives_),
      ground_handle_(multibody_.forces, ground_),
      disturbance_handle_(multibody_.forces,
                          new DisturbingForce(multibody_, *drives_, disturbance)),
      integrator_(multibody_.system) {
  integrator_.setAccuracy(accuracy);
  integrator_.setAllowInterpolation(false);  // every sample is a state that was integrated to
}

void World::start(double time, const RobotState& robot_state, const Eigen::VectorXd& torque) {
  drives_->hold(torque);
  SimTK::State state = multibody_.system.realizeTopology();
  state.setTime(time);
  multibody_.set(state, robot_state);
  integrator_.initialize(state);
  realize();
}

void World::advance(double to, const Eigen::VectorXd& command) {
  drives_->ramp(now(), to, command);
  while (now() < to) integrator_.stepTo(to);
  realize();
}

SimulatedSample World::sample() const {
  const SimTK::State& state = integrator_.getState();
  const SimTK::MobilizedBody& base = multibody_.body(0);
  SimulatedSample result;
  result.state = robot_state();
  result.drive_work = drives_->work(state);
  result.ground_work = ground_->work(state);

  const Eigen::Matrix3d to_base = result.state.base.linear().transpose();
  const Eigen::Vector3d g = to_eigen(multibody_.gravity.getGravityVector(state));
  Sample& s = result.sample;
  s.time = state.getTime();
  s.base_angular_velocity = result.state.base_angular_velocity;
  s.base_angular_acceleration = to_base * to_eigen(base.getBodyAngularAcceleration(state));
  s.base_specific_force = to_base * (to_eigen(base.getBodyOriginAcceleration(state)) - g);
  s.q = result.state.q;
  s.dq = result.state.dq;
  s.ddq.resize(robot_.joint_count());
  for (int j = 0; j < robot_.joint_count(); ++j) {
    s.ddq[j] = multibody_.body(j + 1).getOneUDot(state, 0);
  }
  s.tau = drives_->torque(s.time);
  for (std::size_t c = 0; c < robot_.contacts.size(); ++c) {
    const Eigen::Vector3d force = to_eigen(ground_->force(state, c));
    s.in_contact.push_back(force.z() > 0.0);
    s.contact_force.emplace_back(to_base * force);
  }
  return result;
}

}  // namespace shapeid
