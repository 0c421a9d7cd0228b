#include "shapeid/tests/bench/peers/pinocchio_robot.hpp"

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody/data.hpp>
#include <pinocchio/multibody/model.hpp>

#include "shapeid/models/orders.hpp"

namespace shapeid::bench {
namespace {

pinocchio::SE3 se3(const Eigen::Isometry3d& pose) {
  return {Eigen::Matrix3d(pose.linear()), Eigen::Vector3d(pose.translation())};
}

/// The specialised joint where there is one: it is faster.
pinocchio::JointModel joint_model(const Eigen::Vector3d& axis) {
  if (axis.isApprox(Eigen::Vector3d::UnitX())) return pinocchio::JointModelRX();
  if (axis.isApprox(Eigen::Vector3d::UnitY())) return pinocchio::JointModelRY();
  if (axis.isApprox(Eigen::Vector3d::UnitZ())) return pinocchio::JointModelRZ();
  return pinocchio::JointModelRevoluteUnaligned(axis);
}

pinocchio::Inertia inertia(const Eigen::VectorXd& Phi, int link) {
  const Eigen::VectorXd ours = Phi.segment<10>(10 * link);
  if (ours.isZero(0.0)) return pinocchio::Inertia::Zero();
  const Eigen::VectorXd theirs = to_order(Order::pinocchio, from_order(Order::shapeid, ours));
  return pinocchio::Inertia::FromDynamicParameters(theirs);
}

}  // namespace

struct PinocchioRobot::State {
  pinocchio::Model model;
  pinocchio::Data data;
  std::vector<pinocchio::FrameIndex> contacts;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J6;
  Eigen::MatrixXd J;
};

PinocchioRobot::PinocchioRobot(const Robot& robot, const Eigen::VectorXd& Phi)
    : state_(std::make_unique<State>()) {
  pinocchio::Model& model = state_->model;
  model.gravity.setZero();
  std::vector<pinocchio::JointIndex> joints;
  for (int k = 0; k < robot.link_count(); ++k) {
    const Link& link = robot.links[static_cast<std::size_t>(k)];
    joints.push_back(k == 0 ? model.addJoint(0, pinocchio::JointModelFreeFlyer(),
                                             pinocchio::SE3::Identity(), "base")
                            : model.addJoint(joints[static_cast<std::size_t>(link.parent)],
                                             joint_model(link.joint.axis),
                                             se3(link.joint.placement), link.joint.name));
    model.appendBodyToJoint(joints.back(), inertia(Phi, k));
  }
  for (const Contact& contact : robot.contacts) {
    const pinocchio::JointIndex joint = joints[static_cast<std::size_t>(contact.link)];
    state_->contacts.push_back(model.addFrame(
        pinocchio::Frame(contact.name, joint, 0, se3(contact.frame), pinocchio::OP_FRAME)));
  }
  state_->data = pinocchio::Data(model);
  state_->J6.setZero(6, model.nv);
  state_->J.setZero(3, model.nv);
}

PinocchioRobot::~PinocchioRobot() = default;

PinocchioMotion PinocchioRobot::motion(const Sample& sample) {
  PinocchioMotion m;
  const Eigen::Index n = sample.q.size();
  m.q.resize(7 + n);
  m.q << Eigen::Vector3d::Zero(), Eigen::Vector4d::UnitW(), sample.q;
  m.v.resize(6 + n);
  m.v << Eigen::Vector3d::Zero(), sample.base_angular_velocity, sample.dq;
  m.a.resize(6 + n);
  m.a << sample.base_specific_force, sample.base_angular_acceleration, sample.ddq;
  return m;
}

const Eigen::MatrixXd& PinocchioRobot::regressor(const PinocchioMotion& m) {
  return pinocchio::computeJointTorqueRegressor(state_->model, state_->data, m.q, m.v, m.a);
}

Eigen::Matrix<double, 6, 10> PinocchioRobot::base_regressor(const PinocchioMotion& m) {
  return pinocchio::bodyRegressor(pinocchio::Motion(m.v.head<6>()),
                                  pinocchio::Motion(m.a.head<6>()));
}

const Eigen::VectorXd& PinocchioRobot::inverse_dynamics(const PinocchioMotion& m) {
  return pinocchio::rnea(state_->model, state_->data, m.q, m.v, m.a);
}

const Eigen::MatrixXd& PinocchioRobot::contact_jacobian(const PinocchioMotion& m,
                                                        std::size_t contact) {
  state_->J6.setZero();
  pinocchio::computeFrameJacobian(state_->model, state_->data, m.q, state_->contacts[contact],
                                  pinocchio::LOCAL_WORLD_ALIGNED, state_->J6);
  state_->J = state_->J6.topRows<3>();
  return state_->J;
}

void to_our_order(Eigen::MatrixXd& regressor) {
  for (Eigen::Index link = 0; link + 10 <= regressor.cols(); link += 10)
    regressor.col(link + 6).swap(regressor.col(link + 7));
}

}  // namespace shapeid::bench
