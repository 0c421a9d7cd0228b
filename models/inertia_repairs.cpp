// Finding the cause of an impossible inertia by trying: each known slip is undone, and counts if
// what remains can exist.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "shapeid/models/inertia_lint.hpp"

namespace shapeid::urdf {
namespace {

/// The six numbers in URDF's order of attributes: ixx ixy ixz iyy iyz izz.
using Six = std::array<double, 6>;

Six six_of(const Eigen::Matrix3d& I) {
  return {I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)};
}

Eigen::Matrix3d tensor(double xx, double xy, double xz, double yy, double yz, double zz) {
  Eigen::Matrix3d I;
  I << xx, xy, xz,  //
      xy, yy, yz,   //
      xz, yz, zz;
  return I;
}

/// Six numbers of another library written into URDF's attributes one after the other.
std::vector<Repair> orders(const Six& a) {
  return {
      {"the six numbers are in the order Ixx Ixy Iyy Ixz Iyz Izz (lower triangle by rows, as "
       "Pinocchio), not URDF's ixx ixy ixz iyy iyz izz",
       tensor(a[0], a[1], a[3], a[2], a[4], a[5])},
      {"the six numbers are in the order Ixx Iyy Izz Ixy Ixz Iyz (as MuJoCo and Drake), not URDF's "
       "ixx ixy ixz iyy iyz izz",
       tensor(a[0], a[3], a[4], a[1], a[5], a[2])},
      {"the six numbers are in the order Ixx Iyy Izz Iyz Ixz Ixy (as spatial_v2), not URDF's ixx "
       "ixy ixz iyy iyz izz",
       tensor(a[0], a[5], a[4], a[1], a[3], a[2])},
  };
}

/// m (c^2 1 - c c^T) in inertial axes.
Eigen::Matrix3d parallel_axis_term(const Inertial& inertial) {
  const Eigen::Vector3d c = inertial.origin.linear().transpose() * inertial.origin.translation();
  return inertial.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
}

/// About the centre of mass already, and the parallel axis term was subtracted once more.
Repair steiner_twice(const Inertial& inertial) {
  return {
      "the parallel axis term was subtracted from a tensor that was about the centre of mass "
      "already",
      inertial.tensor + parallel_axis_term(inertial)};
}

/// All ways to exchange the diagonal entries, products kept; and the products, diagonal kept.
std::vector<Repair> permutations(const Six& a) {
  std::vector<Repair> result;
  std::array<std::size_t, 3> order = {0, 1, 2};
  const std::array<double, 3> diagonal = {a[0], a[3], a[5]};
  const std::array<double, 3> products = {a[1], a[2], a[4]};
  while (std::next_permutation(order.begin(), order.end())) {
    const auto& [i, j, k] = order;
    result.push_back({"the diagonal entries ixx, iyy, izz are permuted",
                      tensor(diagonal[i], a[1], a[2], diagonal[j], a[4], diagonal[k])});
    result.push_back({"the products ixy, ixz, iyz are permuted",
                      tensor(a[0], products[i], products[j], a[3], products[k], a[5])});
  }
  return result;
}

/// Products written as the integrals of x y, without the tensor's minus sign.
Repair flipped_products(const Six& a) {
  return {"the products of inertia have the wrong sign (URDF's ixy is minus the integral of x y)",
          tensor(a[0], -a[1], -a[2], a[3], -a[4], a[5])};
}

bool can_exist(double mass, const Eigen::Matrix3d& about_centre) {
  return !why_impossible(from_centre(mass, Eigen::Vector3d::Zero(), about_centre));
}

}  // namespace

Eigen::Matrix3d shifted_to_centre(const Inertial& inertial) {
  return inertial.tensor - parallel_axis_term(inertial);
}

bool explained_by_rounding(const Inertial& inertial) {
  // Rounding moves each diagonal entry by half a digit at most. The triangle inequality gains most
  // when the two smaller ones go up and the largest goes down.
  Eigen::Index largest = 0;
  inertial.tensor.diagonal().maxCoeff(&largest);
  Eigen::Vector3d change(inertial.rounding[0], inertial.rounding[1], inertial.rounding[2]);
  change[largest] = -change[largest];
  const Eigen::Matrix3d unrounded = inertial.tensor + Eigen::Matrix3d(change.asDiagonal());
  return can_exist(inertial.mass, unrounded);
}

std::vector<Repair> plausible_repairs(const DocumentLink& link) {
  const Inertial& inertial = *link.inertial;
  const Six a = six_of(inertial.tensor);
  std::vector<Repair> candidates = orders(a);
  candidates.push_back(flipped_products(a));
  candidates.push_back(steiner_twice(inertial));
  for (Repair& r : permutations(a)) candidates.push_back(std::move(r));

  const std::optional<Extent> extent = collision_extent(link);
  std::vector<Repair> result;
  for (Repair& candidate : candidates) {
    Inertial repaired = inertial;
    repaired.tensor = candidate.tensor;
    const bool known = std::any_of(result.begin(), result.end(),
                                   [&](const Repair& r) { return r.cause == candidate.cause; });
    if (known || !can_exist(inertial.mass, candidate.tensor)) continue;
    if (extent && compare(repaired.parameters(), *extent, generous) != Fit::fits) continue;
    result.push_back(std::move(candidate));
  }
  return result;
}

}  // namespace shapeid::urdf
