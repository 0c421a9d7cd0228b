#include "shapeid/reference/regressor.hpp"

#include <cstddef>

#include "shapeid/models/inertia.hpp"

namespace shapeid::reference {
namespace {

/// I v = L(v) (Ixx, Ixy, Ixz, Iyy, Iyz, Izz)
Eigen::Matrix<double, 3, 6> tensor_times(const Eigen::Vector3d& v) {
  Eigen::Matrix<double, 3, 6> L;
  L << v.x(), v.y(), v.z(), 0.0, 0.0, 0.0,  //
      0.0, v.x(), 0.0, v.y(), v.z(), 0.0,   //
      0.0, 0.0, v.x(), 0.0, v.y(), v.z();
  return L;
}

/// Equation (2) for one body: force and moment about the link origin that its motion takes, linear
/// in its ten parameters. omega, alpha and the origin's proper acceleration a in link axes:
///   f = m a + alpha x h + omega x (omega x h)
///   n = h x a + I alpha + omega x (I omega),   h = m r, I about the link origin.
Eigen::Matrix<double, 6, 10> body_regressor(const Eigen::Vector3d& omega,
                                            const Eigen::Vector3d& alpha,
                                            const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 6, 10> B = Eigen::Matrix<double, 6, 10>::Zero();
  B.block<3, 1>(0, 0) = a;
  B.block<3, 3>(0, 1) = skew(alpha) + skew(omega) * skew(omega);
  B.block<3, 3>(3, 1) = -skew(a);
  B.block<3, 6>(3, 4) = tensor_times(alpha) + skew(omega) * tensor_times(omega);
  return B;
}

}  // namespace

Eigen::Matrix<double, Eigen::Dynamic, 10> link_regressor(const Robot& robot,
                                                         const std::vector<LinkMotion>& motions,
                                                         int link) {
  SHAPEID_CONTRACT(why_not_motions(motions, robot));
  const LinkMotion& motion = motions[static_cast<std::size_t>(link)];
  const Eigen::Matrix3d R = motion.pose.linear();
  Eigen::Matrix<double, 6, 10> B = body_regressor(R.transpose() * motion.angular_velocity,
                                                  R.transpose() * motion.angular_acceleration,
                                                  R.transpose() * motion.proper_acceleration);
  B.topRows<3>() = R * B.topRows<3>();
  B.bottomRows<3>() = R * B.bottomRows<3>();
  // Equation (3): a wrench on the link counts in each generalised direction by the velocity that
  // this direction gives the link (virtual power).
  return point_jacobian(robot, motions, link, motion.pose.translation()).transpose() * B;
}

Eigen::MatrixXd regressor(const Robot& robot, const std::vector<LinkMotion>& motions) {
  Eigen::MatrixXd Y(robot.dof(), 10 * robot.link_count());
  for (int i = 0; i < robot.link_count(); ++i) {
    Y.middleCols<10>(Eigen::Index{10} * i) = link_regressor(robot, motions, i);
  }
  return Y;
}

Eigen::MatrixXd regressor(const Robot& robot, const Sample& sample) {
  return regressor(robot, link_motions(robot, sample));
}

Eigen::VectorXd applied_force(const Robot& robot, const Sample& sample) {
  SHAPEID_CONTRACT(why_malformed(sample, robot));
  Eigen::VectorXd force(robot.dof());
  force << Eigen::VectorXd::Zero(robot.base_dof()), sample.tau;
  return force;
}

}  // namespace shapeid::reference
