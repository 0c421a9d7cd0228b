// What each kind that is a cell of a canonical body says about itself, one file a kind. All the
// rest (placing, dividing, testing) is the same for all of them and stands in shape.cpp.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/shape.hpp"

namespace shapeid {

/// The canonical body as the cell that is all of it.
[[nodiscard]] Cell whole_cell(const Cuboid& cuboid);
[[nodiscard]] Cell whole_cell(const Cylinder& cylinder);
[[nodiscard]] Cell whole_cell(const Ellipsoid& ellipsoid);

/// The coordinate that closes on itself: its bounds may lie anywhere, no more than a turn apart.
inline constexpr int no_axis = -1;
[[nodiscard]] constexpr int turning_axis(const Cuboid&) { return no_axis; }
[[nodiscard]] constexpr int turning_axis(const Cylinder&) { return 1; }
[[nodiscard]] constexpr int turning_axis(const Ellipsoid&) { return 2; }

/// Moments of the cell in canonical coordinates.
[[nodiscard]] Moments canonical_moments(const Cuboid& cuboid);
[[nodiscard]] Moments canonical_moments(const Cylinder& cylinder);
[[nodiscard]] Moments canonical_moments(const Ellipsoid& ellipsoid);

/// Where coordinate `axis` must be cut for the lower part to hold `fraction` of the volume.
[[nodiscard]] double cut_coordinate(const Cuboid& cuboid, int axis, double fraction);
[[nodiscard]] double cut_coordinate(const Cylinder& cylinder, int axis, double fraction);
[[nodiscard]] double cut_coordinate(const Ellipsoid& ellipsoid, int axis, double fraction);

/// Lengths of the cell's sides along its three coordinates, m, as divide() compares them.
[[nodiscard]] Eigen::Vector3d side_lengths(const Cuboid& cuboid);
[[nodiscard]] Eigen::Vector3d side_lengths(const Cylinder& cylinder);
[[nodiscard]] Eigen::Vector3d side_lengths(const Ellipsoid& ellipsoid);

/// Cell coordinates of a canonical point (angles by whole turns near the cell's), and the way back.
[[nodiscard]] Eigen::Vector3d coordinates_of(const Cuboid& cuboid, const Eigen::Vector3d& point);
[[nodiscard]] Eigen::Vector3d coordinates_of(const Cylinder& cylinder,
                                             const Eigen::Vector3d& point);
[[nodiscard]] Eigen::Vector3d coordinates_of(const Ellipsoid& ellipsoid,
                                             const Eigen::Vector3d& point);
[[nodiscard]] Eigen::Vector3d canonical_point(const Cuboid& cuboid,
                                              const Eigen::Vector3d& coordinates);
[[nodiscard]] Eigen::Vector3d canonical_point(const Cylinder& cylinder,
                                              const Eigen::Vector3d& coordinates);
[[nodiscard]] Eigen::Vector3d canonical_point(const Ellipsoid& ellipsoid,
                                              const Eigen::Vector3d& coordinates);

/// The largest value of direction^T p over the canonical points p of the cell.
[[nodiscard]] double support(const Cuboid& cuboid, const Eigen::Vector3d& direction);
[[nodiscard]] double support(const Cylinder& cylinder, const Eigen::Vector3d& direction);
[[nodiscard]] double support(const Ellipsoid& ellipsoid, const Eigen::Vector3d& direction);

/// Root mean square of |linear v| over directions v with the given mean of v v^T.
[[nodiscard]] double rms_stretch(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& mean_vvT);

}  // namespace shapeid
