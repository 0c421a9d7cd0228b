#include "shapeid/fast/regressor.hpp"

#include <Eigen/Geometry>

#include <string>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Matrix3d;
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

/// A motion's force and moment about the link origin for each of the ten parameters: one parameter
/// a row, so that parameters share vector registers. The tensor takes no force.
struct Wrench {
  Eigen::Matrix<double, 4, 3> force;
  Eigen::Matrix<double, 10, 3> moment;
};

/// Equation (2), link axes.
Wrench own_wrench(const LinkMotion& link) noexcept {
  const Vector3d& a = link.a;
  const double x = link.omega.x(), y = link.omega.y(), z = link.omega.z();
  const double ax = link.alpha.x(), ay = link.alpha.y(), az = link.alpha.z();
  const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  Wrench w;
  w.force.row(0) = a;
  w.force.bottomRows<3>() = link.K.transpose();
  // h x a, then L(alpha) + S(omega) L(omega) for (Ixx, Ixy, Ixz, Iyy, Iyz, Izz).
  w.moment << 0.0, 0.0, 0.0,      //
      0.0, -a.z(), a.y(),         //
      a.z(), 0.0, -a.x(),         //
      -a.y(), a.x(), 0.0,         //
      ax, xz, -xy,                //
      ay - xz, ax + yz, xx - yy,  //
      az + xy, zz - xx, ax - yz,  //
      -yz, ay, xy,                //
      yy - zz, az - xy, ay + xz,  //
      yz, -xz, az;
  return w;
}

/// The moment about the base origin that forces at p add.
void add_levers(const Vector3d& p, Wrench& w) noexcept {
  w.moment.topRows<4>().col(0) += p.y() * w.force.col(2) - p.z() * w.force.col(1);
  w.moment.topRows<4>().col(1) += p.z() * w.force.col(0) - p.x() * w.force.col(2);
  w.moment.topRows<4>().col(2) += p.x() * w.force.col(1) - p.y() * w.force.col(0);
}

}  // namespace

// Equation (3): in each generalised direction the wrench counts by the velocity that this direction
// gives the link.
void write_columns(Kinematics& kinematics, int link,
                   Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 10>> Y) noexcept {
  const int base_dof = kinematics.base_dof();
  Wrench w = own_wrench(kinematics.motion(link));
  if (link != 0) {
    const LinkPose& pose = kinematics.pose(link);
    const Matrix3d turned = pose.R.transpose();
    w.force = (w.force * turned).eval();
    w.moment = (w.moment * turned).eval();
    add_levers(pose.p, w);
  }
  if (base_dof != 0) {
    Y.topLeftCorner<3, 4>() = w.force.transpose();
    Y.middleRows<3>(3) = w.moment.transpose();
  }
  for (int i = link; i != 0; i = kinematics.parent(i)) {
    const Vector3d z = kinematics.axis_in_base(i);
    auto row = Y.row(base_dof + i - 1);
    if (kinematics.slides(i)) {
      row.head<4>() = (w.force * z).transpose();
    } else {
      // The axis passes through the joint, not through the base origin.
      const Vector3d lever = kinematics.pose(i).p.cross(z);
      Vector10 share = w.moment * z;
      share.head<4>() += w.force * lever;
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
  kinematics_.start(sample);
  Eigen::Index column = 0;
  for (const int link : wanted_) {
    write_columns(kinematics_, link, Y_.middleCols<10>(column));
    column += 10;
  }
  return Y_;
}

}  // namespace shapeid::fast
