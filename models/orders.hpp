// Claim C12. Inertial parameters in the orders and about the points that other libraries use.
#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>

#include "shapeid/models/inertia.hpp"

namespace shapeid {

// clang-format off
/// Where each library keeps what (SI, link axes unless said):
///   shapeid     m, m rx, m ry, m rz, Ixx, Ixy, Ixz, Iyy, Iyz, Izz   about the origin
///   pinocchio   m, m rx, m ry, m rz, Ixx, Ixy, Iyy, Ixz, Iyz, Izz   about the origin
///   idyntree    as shapeid
///   drake       m, rx, ry, rz, Gxx, Gyy, Gzz, Gxy, Gxz, Gyz         about the origin, per mass
///   mujoco      m, rx, ry, rz, Ixx, Iyy, Izz, Ixy, Ixz, Iyz         about the centre of mass
///   urdf        m, rx, ry, rz, roll, pitch, yaw, Ixx, Ixy, Ixz, Iyy, Iyz, Izz
///                                                     about the centre of mass, in the rotated frame
///   spatial_v2  m, m rx, m ry, m rz, Ixx, Iyy, Izz, Iyz, Ixz, Ixy   about the origin
///   symoro      Ixx, Ixy, Ixz, Iyy, Iyz, Izz, m rx, m ry, m rz, m   about the origin
// clang-format on
enum class Order { shapeid, pinocchio, idyntree, drake, mujoco, urdf, spatial_v2, symoro };

inline constexpr std::array<std::string_view, 8> order_names = {
    "shapeid", "pinocchio", "idyntree", "drake", "mujoco", "urdf", "spatial_v2", "symoro"};

/// Throws InputError for a name that is not in order_names.
[[nodiscard]] Order order_named(std::string_view name);

/// Ten numbers, thirteen for urdf.
[[nodiscard]] Eigen::Index number_count(Order order);

/// from_order throws InputError if the count is wrong, a number is not finite or an angle is more
/// than a turn; to_order if a centre of mass is asked of a massless body that has moments.
[[nodiscard]] InertialParameters from_order(Order order, const Eigen::VectorXd& numbers);
[[nodiscard]] Eigen::VectorXd to_order(Order order, const InertialParameters& body);

}  // namespace shapeid
