#include "shapeid/tests/blind/parts/rotor.hpp"

#include "shapeid/reference/kinematics.hpp"

namespace shapeid::blind {
namespace {

double energy(const Robot& robot, const Sample& s, int joint) {
  const Link& link = robot.links[static_cast<std::size_t>(joint) + 1];
  const auto motions = reference::link_motions(robot, s);
  const Eigen::Vector3d z =
      motions[static_cast<std::size_t>(joint) + 1].pose.linear() * link.joint.axis;
  return s.dq[joint] * z.dot(motions[static_cast<std::size_t>(link.parent)].angular_velocity);
}

/// dT / d dq; T is quadratic in dq, so that the difference is exact.
Eigen::VectorXd momentum(const Robot& robot, Sample s, int joint) {
  Eigen::VectorXd p(s.dq.size());
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const double dq = s.dq[i];
    s.dq[i] = dq + 1.0;
    p[i] = 0.5 * energy(robot, s, joint);
    s.dq[i] = dq - 1.0;
    p[i] -= 0.5 * energy(robot, s, joint);
    s.dq[i] = dq;
  }
  return p;
}

}  // namespace

Eigen::VectorXd rotor_torque(const Robot& robot, const Sample& sample, int joint) {
  constexpr double step = 1e-5;  // s, rad: third root of rounding
  const auto later = [&](double dt) {
    Sample s = sample;
    s.q += dt * sample.dq;
    s.dq += dt * sample.ddq;
    return momentum(robot, s, joint);
  };
  Eigen::VectorXd torque = (later(step) - later(-step)) / (2.0 * step);
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    Sample s = sample;
    s.q[i] += step;
    const double plus = energy(robot, s, joint);
    s.q[i] -= 2.0 * step;
    torque[i] -= (plus - energy(robot, s, joint)) / (2.0 * step);
  }
  return torque;
}

}  // namespace shapeid::blind
