// What is wrong with an <inertial>, and what probably caused it. Internal to models.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/urdf.hpp"
#include "shapeid/models/urdf_document.hpp"

namespace shapeid::urdf {

/// Axis-aligned bounds in link axes, m.
struct Extent {
  Eigen::Vector3d lower, upper;
};

/// Bounds of the link's collision bodies; empty if it has none, or one whose size is not in the
/// file (a mesh).
[[nodiscard]] std::optional<Extent> collision_extent(const DocumentLink& link);

/// How a body compares with the space that its link occupies.
enum class Fit { fits, centre_outside, too_large, too_small };

/// A mass distribution inside [a, b] with mean c has a variance of at most (b - c)(c - a) along
/// that axis (Bhatia and Davis 2000). `padding` widens the extent on every side, in units of its
/// largest side: collision geometry is drawn roughly, and motors stand out of it.
[[nodiscard]] Fit compare(const InertialParameters& body, const Extent& extent, double padding);

/// Only slips by orders of magnitude put a real link outside this.
inline constexpr double generous = 1.0;

/// A slip that would explain an impossible tensor, and the tensor that was meant (inertial axes).
struct Repair {
  std::string cause;
  Eigen::Matrix3d tensor;
};

/// The slips that, undone, leave a body that can exist (and that fits the collision geometry, where
/// that is known); the most usual first.
[[nodiscard]] std::vector<Repair> plausible_repairs(const DocumentLink& link);

/// Whether the numbers as written could have been rounded from those of a body that can exist.
[[nodiscard]] bool explained_by_rounding(const Inertial& inertial);

/// The tensor about the centre of mass if the one given is about the link's origin instead
/// (inertial axes).
[[nodiscard]] Eigen::Matrix3d shifted_to_centre(const Inertial& inertial);

/// The finding about one link as written, if there is one; `file` stands in its place. An inertia
/// that no body can have is fatal here, unless it is rounding.
[[nodiscard]] std::optional<InertiaFinding> lint(const DocumentLink& link, const std::string& file);

/// One line for a finding: "inertia of link X: wrong (likely cause)".
[[nodiscard]] std::string describe(const InertiaFinding& finding);

}  // namespace shapeid::urdf
