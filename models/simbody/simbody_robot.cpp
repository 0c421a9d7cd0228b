#include "shapeid/models/simbody/simbody_robot.hpp"

#include "shapeid/models/simbody/multibody.hpp"

namespace shapeid {
namespace {

/// The base's attitude, place and linear velocity that a Sample does not have. Any would do; these
/// are plainly not zero, so that a mistake that depends on them shows.
RobotState anywhere(const Robot& robot) {
  RobotState s;
  s.base.linear() = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  s.base.translation() << 0.3, -0.8, 1.2;
  s.base_linear_velocity << 0.9, -0.5, 0.6;
  s.q = Eigen::VectorXd::Zero(robot.joint_count());
  s.dq = Eigen::VectorXd::Zero(robot.joint_count());
  return s;
}

}  // namespace

struct SimbodyRobot::State {
  explicit State(const Robot& robot_in)
      : robot(robot_in), multibody(robot_in), state(multibody.system.realizeTopology()) {}

  /// Puts the robot at q, somewhere in the world.
  RobotState configure(const Eigen::VectorXd& q) {
    RobotState s = anywhere(robot);
    s.q = q;
    multibody.set(state, s);
    multibody.system.realize(state, SimTK::Stage::Velocity);
    return s;
  }

  Robot robot;
  Multibody multibody;
  SimTK::State state;
};

SimbodyRobot::SimbodyRobot(const Robot& robot) : state_(std::make_unique<State>(robot)) {}
SimbodyRobot::~SimbodyRobot() = default;
SimbodyRobot::SimbodyRobot(SimbodyRobot&&) noexcept = default;
SimbodyRobot& SimbodyRobot::operator=(SimbodyRobot&&) noexcept = default;

Eigen::VectorXd SimbodyRobot::inverse_dynamics(const Sample& sample) const {
  const Multibody& multibody = state_->multibody;
  SimTK::State& state = state_->state;

  RobotState s = anywhere(state_->robot);
  s.q = sample.q;
  s.dq = sample.dq;
  s.base_angular_velocity = sample.base_angular_velocity;
  multibody.set(state, s);

  const Eigen::Matrix3d R = s.base.linear();
  Eigen::Vector3d g = gravity();
  Eigen::VectorXd acceleration(multibody.base_dof() + multibody.joint_count());
  if (multibody.floating()) {
    acceleration.head<3>() = sample.base_specific_force + R.transpose() * g;
    acceleration.segment<3>(3) = sample.base_angular_acceleration;
  } else {
    g = -sample.base_specific_force;
  }
  acceleration.tail(multibody.joint_count()) = sample.ddq;
  multibody.gravity.setGravityVector(state, to_vec3(g));
  multibody.system.realize(state, SimTK::Stage::Dynamics);

  const Eigen::MatrixXd T = multibody.mobilities_from_generalised(R);
  const SimTK::Vector udot = to_vector(T * acceleration);
  SimTK::Vector residual;
  multibody.matter.calcResidualForceIgnoringConstraints(
      state, SimTK::Vector(), multibody.gravity.getBodyForces(state), udot, residual);
  return T.transpose() * to_eigen(residual);
}

Eigen::MatrixXd SimbodyRobot::mass_matrix(const Eigen::VectorXd& q) const {
  const RobotState s = state_->configure(q);
  SimTK::Matrix M;
  state_->multibody.matter.calcM(state_->state, M);
  const Eigen::MatrixXd T = state_->multibody.mobilities_from_generalised(s.base.linear());
  return T.transpose() * to_eigen(M) * T;
}

Eigen::Matrix3Xd SimbodyRobot::contact_positions(const Eigen::VectorXd& q) const {
  const RobotState s = state_->configure(q);
  const std::vector<Contact>& contacts = state_->robot.contacts;
  const SimTK::MobilizedBody& base = state_->multibody.body(0);
  Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(contacts.size()));
  for (Eigen::Index c = 0; c < positions.cols(); ++c) {
    const Contact& contact = contacts[static_cast<std::size_t>(c)];
    positions.col(c) = to_eigen(state_->multibody.body(contact.link)
                                    .findStationLocationInAnotherBody(
                                        state_->state, to_vec3(contact.frame.translation()), base));
  }
  return positions;
}

Eigen::MatrixXd SimbodyRobot::contact_point_jacobian(const Eigen::VectorXd& q) const {
  const RobotState s = state_->configure(q);
  const Eigen::Matrix3d R = s.base.linear();
  const Eigen::Matrix3d to_base =
      state_->multibody.floating() ? Eigen::Matrix3d(R.transpose()) : Eigen::Matrix3d::Identity();
  const Eigen::MatrixXd T = state_->multibody.mobilities_from_generalised(R);
  const std::vector<Contact>& contacts = state_->robot.contacts;
  Eigen::MatrixXd J(3 * static_cast<Eigen::Index>(contacts.size()), T.cols());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    SimTK::Matrix JS;
    state_->multibody.matter.calcStationJacobian(
        state_->state, state_->multibody.body(contacts[c].link).getMobilizedBodyIndex(),
        to_vec3(contacts[c].frame.translation()), JS);
    J.middleRows<3>(3 * static_cast<Eigen::Index>(c)) = to_base * to_eigen(JS) * T;
  }
  return J;
}

double SimbodyRobot::kinetic_energy(const RobotState& robot_state) const {
  state_->multibody.set(state_->state, robot_state);
  state_->multibody.system.realize(state_->state, SimTK::Stage::Velocity);
  return state_->multibody.matter.calcKineticEnergy(state_->state);
}

double SimbodyRobot::potential_energy(const RobotState& robot_state) const {
  state_->multibody.set(state_->state, robot_state);
  state_->multibody.gravity.setGravityVector(state_->state, to_vec3(gravity()));
  state_->multibody.system.realize(state_->state, SimTK::Stage::Dynamics);
  return state_->multibody.system.calcPotentialEnergy(state_->state);
}

Eigen::Vector3d SimbodyRobot::gravity() { return {0.0, 0.0, -9.81}; }

}  // namespace shapeid
