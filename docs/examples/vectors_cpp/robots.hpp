// Robots as trees of links: where everything is, how it moves, and the rows of the dynamics. In
// base axes, seen from the frame that falls with the base origin and moves with its velocity now.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <vector>

#include "bodies.hpp"
#include "json.hpp"

namespace example {

using Eigen::Vector3d;

/// Force and moment about the moving origin, one column a parameter.
inline Eigen::MatrixXd body_rows(const Vector3d& omega, const Vector3d& alpha, const Vector3d& a) {
  Eigen::MatrixXd Y(6, 10);
  for (int j = 0; j < 10; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(10, j);
    const Vector3d h = unit.segment<3>(1);
    const Eigen::Matrix3d I = read_tensor(order_named("shapeid"), unit.tail(6));
    Y.col(j).head<3>() = unit[0] * a + alpha.cross(h) + omega.cross(omega.cross(h));
    Y.col(j).tail<3>() = I * alpha + omega.cross(I * omega) + h.cross(a);
  }
  return Y;
}

/// Linear and angular velocity of a point of a body.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

struct LinkMotion {
  Eigen::Matrix3d R;
  Vector3d p, omega, alpha, a;
  Jacobian J;  ///< of the link's origin
};

inline Jacobian moved_to(const Jacobian& J, const Vector3d& way) {
  Jacobian moved = J;
  for (Eigen::Index k = 0; k < J.cols(); ++k) {
    const Vector3d turning = J.col(k).tail<3>();
    moved.col(k).head<3>() += turning.cross(way);
  }
  return moved;
}

inline std::vector<LinkMotion> link_motions(const Json& robot, const Json& sample) {
  const std::vector<Json>& links = robot["links"].items;
  const Eigen::Index base = robot["root"].text == "floating" ? 6 : 0;
  const Eigen::VectorXd q = sample["q"].numbers(), dq = sample["dq"].numbers(),
                        ddq = sample["ddq"].numbers();
  std::vector<LinkMotion> motions(1);
  motions[0] = {Eigen::Matrix3d::Identity(),          Vector3d::Zero(),
                sample["angular_velocity"].numbers(), sample["angular_acceleration"].numbers(),
                sample["specific_force"].numbers(),   Jacobian::Zero(6, base + q.size())};
  if (base > 0) motions[0].J.leftCols<6>().setIdentity();
  for (std::size_t i = 1; i < links.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i) - 1;
    const LinkMotion& up = motions[static_cast<std::size_t>(links[i]["parent"].integer())];
    const Vector3d own_axis = links[i]["axis"].numbers();
    const Eigen::Matrix3d R = up.R * rotation(links[i]["rpy"].numbers());
    const Vector3d z = R * own_axis;
    Vector3d way = up.R * links[i]["xyz"].numbers();
    LinkMotion link = up;
    if (links[i]["joint"].text == "revolute") {
      link.R = R * Eigen::AngleAxisd(q[j], own_axis).toRotationMatrix();
      link.omega += dq[j] * z;
      link.alpha += ddq[j] * z + up.omega.cross(dq[j] * z);
    } else {
      link.R = R;
      way += q[j] * z;
      link.a += 2.0 * up.omega.cross(dq[j] * z) + ddq[j] * z;
    }
    link.p += way;
    link.a += up.alpha.cross(way) + up.omega.cross(up.omega.cross(way));
    link.J = moved_to(up.J, way);
    (links[i]["joint"].text == "revolute" ? link.J.col(base + j).tail<3>()
                                          : link.J.col(base + j).head<3>()) = z;
    motions.push_back(link);
  }
  return motions;
}

/// Y: generalised order, ten columns a link.
inline Eigen::MatrixXd robot_rows(const std::vector<LinkMotion>& motions) {
  const auto links = static_cast<Eigen::Index>(motions.size());
  Eigen::MatrixXd Y(motions[0].J.cols(), 10 * links);
  for (Eigen::Index i = 0; i < links; ++i) {
    const LinkMotion& link = motions[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d back = link.R.transpose();
    Eigen::MatrixXd B = body_rows(back * link.omega, back * link.alpha, back * link.a);
    B.topRows<3>() = (link.R * B.topRows<3>()).eval();
    B.bottomRows<3>() = (link.R * B.bottomRows<3>()).eval();
    Y.middleCols(10 * i, 10) = link.J.transpose() * B;
  }
  return Y;
}

/// Rows of J: what a contact holds still. A point its velocity, a line also its turning about y and
/// z of its frame, a plane all turning.
inline Eigen::MatrixXd contact_rows(const Json& robot, const std::vector<LinkMotion>& motions) {
  Eigen::MatrixXd J(0, motions[0].J.cols());
  for (const Json& contact : robot["contacts"].items) {
    const LinkMotion& link = motions[static_cast<std::size_t>(contact["link"].integer())];
    const Jacobian all = moved_to(link.J, link.R * contact["xyz"].numbers());
    const std::string& kind = contact["kind"].text;
    const Eigen::Index turning = kind == "plane" ? 3 : kind == "line" ? 2 : 0;
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
    if (kind == "line") axes = link.R * rotation(contact["rpy"].numbers());
    J.conservativeResize(J.rows() + 3 + turning, Eigen::NoChange);
    J.bottomRows(3 + turning) << all.topRows<3>(),
        axes.rightCols(turning).transpose() * all.bottomRows<3>();
  }
  return J;
}

/// Rows of [Y F] with contact forces eliminated: Q2^T W^(1/2) [Y F].
struct FreeRows {
  Eigen::MatrixXd YF;
  Eigen::Index rank;
};

inline FreeRows without_forces(const Eigen::MatrixXd& YF, const Eigen::MatrixXd& J,
                               const Eigen::VectorXd& weight) {
  const Eigen::VectorXd roots = weight.cwiseSqrt();
  const Eigen::MatrixXd weighted = roots.asDiagonal() * YF;
  if (J.rows() == 0) return {weighted, 0};
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(roots.asDiagonal() * J.transpose());
  qr.setThreshold(1e-12);
  const Eigen::MatrixXd turned = qr.householderQ().adjoint() * weighted;
  return {turned.bottomRows(YF.rows() - qr.rank()), qr.rank()};
}

}  // namespace example
