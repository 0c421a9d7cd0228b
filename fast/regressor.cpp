#include "shapeid/fast/regressor.hpp"

#include <Eigen/Geometry>

#include <string>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Vector3d;

[[maybe_unused]] Violation why_unknown_link(const Robot& robot, const std::vector<int>& links) {
  for (const int link : links) {
    if (link < 0 || link >= robot.link_count()) {
      return "link " + std::to_string(link) + " is wanted of a robot that has " +
             std::to_string(robot.link_count());
    }
  }
  return std::nullopt;
}

[[maybe_unused]] Violation why_other_size(const Eigen::Ref<Eigen::MatrixXd>& Y, Eigen::Index rows,
                                          Eigen::Index columns) {
  if (Y.rows() == rows && Y.cols() == columns) return std::nullopt;
  return "a block of " + std::to_string(rows) + " x " + std::to_string(columns) +
         " is to be written to " + std::to_string(Y.rows()) + " x " + std::to_string(Y.cols());
}

}  // namespace

Eigen::Matrix<double, 10, 6> body_wrench(const LinkMotion& link) noexcept {
  const Vector3d& a = link.a;
  const double x = link.omega.x(), y = link.omega.y(), z = link.omega.z();
  const double ax = link.alpha.x(), ay = link.alpha.y(), az = link.alpha.z();
  const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  Eigen::Matrix<double, 10, 6> w;
  w.topLeftCorner<1, 3>() = a.transpose();
  w.block<3, 3>(1, 0) = link.K.transpose();
  w.bottomLeftCorner<6, 3>().setZero();
  // h x a, then L(alpha) + S(omega) L(omega) for (Ixx, Ixy, Ixz, Iyy, Iyz, Izz).
  w.rightCols<3>() << 0.0, 0.0, 0.0,  //
      0.0, -a.z(), a.y(),             //
      a.z(), 0.0, -a.x(),             //
      -a.y(), a.x(), 0.0,             //
      ax, xz, -xy,                    //
      ay - xz, ax + yz, xx - yy,      //
      az + xy, zz - xx, ax - yz,      //
      -yz, ay, xy,                    //
      yy - zz, az - xy, ay + xz,      //
      yz, -xz, az;
  return w;
}

// Equation (3): in each generalised direction the wrench counts by the velocity that this direction
// gives the link.
void write_columns(Kinematics& kinematics, int link,
                   Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 10>> Y) noexcept {
  const int base_dof = kinematics.base_dof();
  const Eigen::Matrix<double, 10, 6> own = body_wrench(kinematics.motion(link));
  // In base axes; about the base origin. The tensor takes no force.
  Eigen::Matrix<double, 4, 3> force = own.topLeftCorner<4, 3>();
  Eigen::Matrix<double, 10, 3> moment = own.rightCols<3>();
  if (link != 0) {
    const LinkPose& pose = kinematics.pose(link);
    const Vector3d& p = pose.p;
    force.noalias() = own.topLeftCorner<4, 3>() * pose.R.transpose();
    moment.noalias() = own.rightCols<3>() * pose.R.transpose();
    moment.topRows<4>().col(0) += p.y() * force.col(2) - p.z() * force.col(1);
    moment.topRows<4>().col(1) += p.z() * force.col(0) - p.x() * force.col(2);
    moment.topRows<4>().col(2) += p.x() * force.col(1) - p.y() * force.col(0);
  }
  if (base_dof != 0) {
    Y.topLeftCorner<3, 4>() = force.transpose();
    Y.middleRows<3>(3) = moment.transpose();
  }
  for (int i = link; i != 0; i = kinematics.parent(i)) {
    const Vector3d z = kinematics.axis_in_base(i);
    auto row = Y.row(base_dof + i - 1);
    if (kinematics.slides(i)) {
      row.head<4>() = (force * z).transpose();
    } else {
      // The axis passes through the joint, not through the base origin.
      const Vector3d lever = kinematics.pose(i).p.cross(z);
      Vector10 share = moment * z;
      share.head<4>() += force * lever;
      row = share.transpose();
    }
  }
}

Regressor::Regressor(const Robot& robot, const std::vector<int>& links)
    : kinematics_(robot), wanted_(links) {
  SHAPEID_CONTRACT(why_unknown_link(robot, links));
  Y_.setZero(robot.dof(), 10 * static_cast<Eigen::Index>(links.size()));
}

const Eigen::MatrixXd& Regressor::operator()(const Sample& sample) noexcept {
  write(sample, Y_);
  return Y_;
}

void Regressor::of_block(std::span<const Sample> samples, Eigen::Ref<Eigen::MatrixXd> Y) noexcept {
  const Eigen::Index dof = Y_.rows();
  SHAPEID_CONTRACT(why_other_size(Y, static_cast<Eigen::Index>(samples.size()) * dof, Y_.cols()));
  Y.setZero();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    write(samples[k], Y.middleRows(static_cast<Eigen::Index>(k) * dof, dof));
  }
}

void Regressor::write(const Sample& sample, Eigen::Ref<Eigen::MatrixXd> Y) noexcept {
  kinematics_.start(sample);
  Eigen::Index column = 0;
  for (const int link : wanted_) {
    write_columns(kinematics_, link, Y.middleCols<10>(column));
    column += 10;
  }
}

}  // namespace shapeid::fast
