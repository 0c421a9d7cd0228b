// Rigid bodies as moments up to order two: Sigma = integral of (x, 1)(x, 1)^T dm, 4 x 4. A map T of
// space takes it to T Sigma T^T, which is the parallel axis theorem, the turning of axes and the
// stretching of a shape in one.
#pragma once

#include <Eigen/Geometry>

#include <map>
#include <string>

namespace example {

using Sigma = Eigen::Matrix4d;

/// R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
inline Eigen::Matrix3d rotation(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

inline Eigen::Matrix4d pose(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = rotation(rpy);
  T.topRightCorner<3, 1>() = xyz;
  return T;
}

inline Sigma mapped(const Eigen::Matrix4d& T, const Sigma& body) {
  return T * body * T.transpose();
}

/// From second moments to the tensor, I = tr(S) 1 - S, and back.
inline Eigen::Matrix3d tensor(const Eigen::Matrix3d& S) {
  return S.trace() * Eigen::Matrix3d::Identity() - S;
}
inline Eigen::Matrix3d second_moments(const Eigen::Matrix3d& I) {
  return 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
}

inline Sigma body(double mass, const Eigen::Vector3d& h, const Eigen::Matrix3d& S) {
  Sigma made;
  made << S, h, h.transpose(), mass;
  return made;
}

/// What an order keeps: the six entries of the tensor by name, and about which point.
struct OrderOfNumbers {
  std::string entries;  ///< "xx", ... in their order, without spaces between
  bool about_centre = false, per_mass = false, rotated = false, mass_last = false;
};

inline const OrderOfNumbers& order_named(const std::string& name) {
  static const std::map<std::string, OrderOfNumbers> orders = {
      {"shapeid", {"xxxyxzyyyzzz"}},
      {"idyntree", {"xxxyxzyyyzzz"}},
      {"pinocchio", {"xxxyyyxzyzzz"}},
      {"spatial_v2", {"xxyyzzyzxzxy"}},
      {"drake", {"xxyyzzxyxzyz", false, true}},
      {"mujoco", {"xxyyzzxyxzyz", true}},
      {"urdf", {"xxxyxzyyyzzz", true, false, true}},
      {"symoro", {"xxxyxzyyyzzz", false, false, false, true}}};
  return orders.at(name);
}

inline Eigen::Matrix3d read_tensor(const OrderOfNumbers& order, const Eigen::VectorXd& six) {
  Eigen::Matrix3d I;
  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto at = 2 * static_cast<std::size_t>(k);
    const int i = order.entries[at] - 'x', j = order.entries[at + 1] - 'x';
    I(i, j) = I(j, i) = six[k];
  }
  return I;
}

inline Eigen::VectorXd write_tensor(const OrderOfNumbers& order, const Eigen::Matrix3d& I) {
  Eigen::VectorXd six(6);
  for (Eigen::Index k = 0; k < 6; ++k) {
    const auto at = 2 * static_cast<std::size_t>(k);
    six[k] = I(order.entries[at] - 'x', order.entries[at + 1] - 'x');
  }
  return six;
}

inline Sigma read_body(const std::string& name, const Eigen::VectorXd& v) {
  const OrderOfNumbers& order = order_named(name);
  if (order.mass_last) {
    return body(v[9], v.segment<3>(6), second_moments(read_tensor(order, v.head(6))));
  }
  const Eigen::Vector3d second = v.segment<3>(1);  // a place, or a first moment
  const Eigen::Matrix3d S = second_moments(read_tensor(order, v.tail(6)));
  if (order.per_mass) return v[0] * body(1.0, second, S);
  if (!order.about_centre) return body(v[0], second, S);
  const Eigen::Vector3d rpy =
      order.rotated ? Eigen::Vector3d(v.segment<3>(4)) : Eigen::Vector3d::Zero();
  return mapped(pose(second, rpy), body(v[0], Eigen::Vector3d::Zero(), S));
}

inline Eigen::VectorXd write_body(const std::string& name, const Sigma& given) {
  const OrderOfNumbers& order = order_named(name);
  const double mass = given(3, 3);
  Sigma about = given;
  Eigen::Vector3d second = given.topRightCorner<3, 1>();
  if (order.about_centre || order.per_mass) second /= mass;
  if (order.about_centre) about = mapped(pose(-second, Eigen::Vector3d::Zero()), given);
  if (order.per_mass) about /= mass;
  const Eigen::VectorXd six = write_tensor(order, tensor(about.topLeftCorner<3, 3>()));
  Eigen::VectorXd v(order.rotated ? 13 : 10);
  if (order.mass_last) {
    v << six, second, mass;
  } else if (order.rotated) {
    v << mass, second, Eigen::Vector3d::Zero(), six;
  } else {
    v << mass, second, six;
  }
  return v;
}

inline Eigen::VectorXd parameters(const Sigma& given) { return write_body("shapeid", given); }

}  // namespace example
