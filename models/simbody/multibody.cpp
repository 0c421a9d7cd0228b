#include "shapeid/models/simbody/multibody.hpp"

#include <exception>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

SimTK::MassProperties mass_properties(const Link& link) {
  const InertialParameters& body = link.inertia;
  if (const Violation why = why_impossible(body)) {
    throw InputError("link " + link.name + " cannot exist: " + *why, "a physically consistent one");
  }
  const Eigen::Matrix3d I = body.tensor();
  return SimTK::MassProperties(
      body.mass(), to_vec3(body.centre_of_mass()),
      SimTK::Inertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
}

/// A rotation that takes the given axis of a mobilizer's frame to the joint's axis.
SimTK::Transform axis_frame(const Joint& joint, const SimTK::CoordinateAxis& mobilizer_axis) {
  return SimTK::Rotation(SimTK::UnitVec3(to_vec3(joint.axis)), mobilizer_axis);
}

/// Child pose = placement * motion about the joint's axis, so both mobilizer frames are turned
/// alike.
SimTK::MobilizedBody attach(SimTK::MobilizedBody& parent, const Joint& joint,
                            const SimTK::Body& body) {
  const SimTK::Transform placement = to_transform(joint.placement);
  if (joint.kind == JointKind::prismatic) {
    const SimTK::Transform frame = axis_frame(joint, SimTK::XAxis);
    return SimTK::MobilizedBody::Slider(parent, placement * frame, body, frame);
  }
  const SimTK::Transform frame = axis_frame(joint, SimTK::ZAxis);
  return SimTK::MobilizedBody::Pin(parent, placement * frame, body, frame);
}

}  // namespace

SimTK::Vec3 to_vec3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

SimTK::Vector to_vector(const Eigen::VectorXd& v) {
  SimTK::Vector result(static_cast<int>(v.size()));
  for (int i = 0; i < result.size(); ++i) result[i] = v[i];
  return result;
}

SimTK::Transform to_transform(const Eigen::Isometry3d& T) {
  SimTK::Mat33 R;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) R(i, k) = T.linear()(i, k);
  }
  constexpr bool as_it_is = true;  // orthogonal already: do not renormalise
  return {SimTK::Rotation(R, as_it_is), to_vec3(T.translation())};
}

Eigen::Vector3d to_eigen(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

Eigen::VectorXd to_eigen(const SimTK::Vector& v) {
  Eigen::VectorXd result(v.size());
  for (int i = 0; i < v.size(); ++i) result[i] = v[i];
  return result;
}

Eigen::Matrix3d to_eigen(const SimTK::Rotation& R) {
  Eigen::Matrix3d m;
  for (int k = 0; k < 3; ++k) m.col(k) = to_eigen(R.col(k).asVec3());
  return m;
}

Eigen::MatrixXd to_eigen(const SimTK::Matrix& M) {
  Eigen::MatrixXd result(M.nrow(), M.ncol());
  for (int i = 0; i < M.nrow(); ++i) {
    for (int k = 0; k < M.ncol(); ++k) result(i, k) = M(i, k);
  }
  return result;
}

Multibody::Multibody(const Robot& robot) : floating_(robot.root == Root::floating) {
  SHAPEID_CONTRACT(why_malformed(robot));
  for (const Link& link : robot.links) {
    const bool root = bodies_.empty();
    if (root && !floating_) {
      bodies_.push_back(matter.Ground());
      continue;
    }
    try {
      const SimTK::Body::Rigid body(mass_properties(link));
      if (root) {
        bodies_.push_back(SimTK::MobilizedBody::Free(matter.Ground(), body));
      } else {
        bodies_.push_back(attach(bodies_[static_cast<std::size_t>(link.parent)], link.joint, body));
      }
    } catch (const SimTK::Exception::Base& refused) {
      throw InputError("Simbody refuses link " + link.name + ": " + refused.getMessage(),
                       "a physically consistent one");
    }
  }
}

void Multibody::set(SimTK::State& state, const RobotState& robot_state) const {
  const Eigen::Matrix3d R = robot_state.base.linear();
  if (floating_) {
    body(0).setQToFitTransform(state, to_transform(robot_state.base));
    body(0).setUToFitAngularVelocity(state, to_vec3(R * robot_state.base_angular_velocity));
    body(0).setUToFitLinearVelocity(state, to_vec3(R * robot_state.base_linear_velocity));
  }
  for (int j = 0; j < joint_count(); ++j) {
    body(j + 1).setOneQ(state, 0, robot_state.q[j]);
    body(j + 1).setOneU(state, 0, robot_state.dq[j]);
  }
}

RobotState Multibody::get(const SimTK::State& state) const {
  RobotState s;
  if (floating_) {
    const SimTK::Transform& X = body(0).getBodyTransform(state);
    const Eigen::Matrix3d R = to_eigen(X.R());
    s.base.linear() = R;
    s.base.translation() = to_eigen(X.p());
    s.base_linear_velocity = R.transpose() * to_eigen(body(0).getBodyOriginVelocity(state));
    s.base_angular_velocity = R.transpose() * to_eigen(body(0).getBodyAngularVelocity(state));
  }
  s.q.resize(joint_count());
  s.dq.resize(joint_count());
  for (int j = 0; j < joint_count(); ++j) {
    s.q[j] = body(j + 1).getOneQ(state, 0);
    s.dq[j] = body(j + 1).getOneU(state, 0);
  }
  return s;
}

Eigen::MatrixXd Multibody::mobilities_from_generalised(const Eigen::Matrix3d& R) const {
  const Eigen::Index n = base_dof() + joint_count();
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(n, n);
  if (floating_) {
    T.topLeftCorner<6, 6>().setZero();
    T.block<3, 3>(0, 3) = R;  // Simbody: angular first
    T.block<3, 3>(3, 0) = R;
  }
  return T;
}

}  // namespace shapeid
