// Claim C7. The ten inertial parameters of a rigid body, and the 4x4 pseudo-inertia that decides
// whether a body with them can exist.
//
// Order: m, m rx, m ry, m rz, Ixx, Ixy, Ixz, Iyy, Iyz, Izz. Units: kg, kg m, kg m^2. Frame: link
// axes; first moment and tensor about the link frame's *origin*; products carry the tensor's sign,
// Ixy = - integral of x y dm.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

#include "shapeid/models/alignment.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid {

using Vector10 = Eigen::Matrix<double, 10, 1>;

/// The ten in their order, as messages call them.
inline constexpr std::array<const char*, 10> parameter_names = {
    "m", "m rx", "m ry", "m rz", "Ixx", "Ixy", "Ixz", "Iyy", "Iyz", "Izz"};

/// Sigma = [[ integral r r^T dm, m r ], [ (m r)^T, m ]], link axes, about the link origin.
/// With m > 0 it is positive semidefinite if and only if some nonnegative mass distribution has
/// these moments (Wensing, Kim, Slotine 2017): tensor about the centre of mass >= 0 and the
/// triangle inequalities together. With m = 0 only the zero matrix belongs to a body.
using PseudoInertia = Eigen::Matrix4d;

/// Inertial parameters of one body in one frame. A plain vector with names.
struct InertialParameters {
  Vector10 values = Vector10::Zero();

  /// kg
  [[nodiscard]] double mass() const { return values[0]; }
  /// kg m: mass times centre of mass
  [[nodiscard]] Eigen::Vector3d first_moment() const { return values.segment<3>(1); }
  /// kg m^2: tensor about the frame's origin
  [[nodiscard]] Eigen::Matrix3d tensor() const;
  /// m; the zero vector for a massless body
  [[nodiscard]] Eigen::Vector3d centre_of_mass() const;
  /// kg m^2: tensor about the centre of mass, same axes (parallel axis theorem)
  [[nodiscard]] Eigen::Matrix3d tensor_about_centre() const;
};

/// From mass (kg), centre of mass (m) and the tensor about the centre of mass (kg m^2), all in the
/// axes of the frame whose origin the result refers to.
[[nodiscard]] InertialParameters from_centre(double mass, const Eigen::Vector3d& centre,
                                             const Eigen::Matrix3d& tensor_about_centre);

/// From mass (kg), first moment (kg m) and the tensor about the frame's origin (kg m^2).
[[nodiscard]] InertialParameters from_origin(double mass, const Eigen::Vector3d& first_moment,
                                             const Eigen::Matrix3d& tensor);

/// Two bodies that move as one: moments add when they are about the same origin.
[[nodiscard]] InertialParameters operator+(const InertialParameters& a,
                                           const InertialParameters& b);
[[nodiscard]] InertialParameters operator*(double factor, const InertialParameters& a);

/// The same body seen from another frame: `placement` maps coordinates of the present frame to
/// coordinates of the new one (Sigma' = T Sigma T^T).
[[nodiscard]] InertialParameters moved(const InertialParameters& body,
                                       const Eigen::Isometry3d& placement);

[[nodiscard]] PseudoInertia pseudo_inertia(const InertialParameters& body);
[[nodiscard]] InertialParameters from_pseudo_inertia(const PseudoInertia& sigma);

/// The smallest eigenvalue of the pseudo-inertia in units of the body's own mass and size: scaled
/// so that |m| and the largest |entry| of the block of second moments become one. Zero on the edge
/// of the cone (a point, a rod, a plate), negative for a body that cannot exist: -1 for one that
/// has no mass, or no second moments, and is neither a point at the origin nor all zero. No unit.
[[nodiscard]] double consistency_margin(const InertialParameters& body);

/// Empty if the body can exist (margin not below -tolerance); else the inequality that is broken,
/// its margin, and what usually causes it.
[[nodiscard]] Violation why_impossible(const InertialParameters& body, double tolerance = 1e-10);

}  // namespace shapeid
