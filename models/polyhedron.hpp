// Solids bounded by plane sides: integrals, topology, cuts. Private to the shapes.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <utility>
#include <vector>

#include "shapeid/models/shape.hpp"

namespace shapeid {

/// Empty if indices, numbers, closure, orientation and volume are in order.
[[nodiscard]] Violation why_malformed(const Polyhedron& polyhedron);

/// Exact integrals over the tetrahedra between the triangles and a point amid the solid.
[[nodiscard]] Moments moments(const Polyhedron& polyhedron);

/// Whether no edge is re-entrant by more than single precision of the size, in one piece.
[[nodiscard]] bool is_convex(const Polyhedron& polyhedron);

/// The corners of a triangle as seen from `origin`.
[[nodiscard]] std::array<Eigen::Vector3d, 3> corners(const Polyhedron& polyhedron,
                                                     const std::array<int, 3>& face,
                                                     const Eigen::Vector3d& origin);

/// How often the surface winds about a point: 1 inside a solid, 0 outside.
[[nodiscard]] double winding(const Polyhedron& polyhedron, const Eigen::Vector3d& point);

/// Inside (the surface winds around the point), or no farther than `slack` from the surface.
[[nodiscard]] bool contains(const Polyhedron& polyhedron, const Eigen::Vector3d& point,
                            double slack);

/// The principal direction of largest spread; among directions that tie, the one nearest to the
/// lowest axis. Its largest component is positive.
[[nodiscard]] Eigen::Vector3d longest_direction(const Polyhedron& polyhedron);

/// Cuts a convex solid across the unit vector `direction` so that the lower part holds `fraction`
/// of the volume. Empty if the solid is too thin for that.
[[nodiscard]] std::optional<std::pair<Polyhedron, Polyhedron>> cut(const Polyhedron& polyhedron,
                                                                   const Eigen::Vector3d& direction,
                                                                   double fraction);

/// The directed edges of a set of triangles that no other triangle runs through backwards: empty
/// for a closed surface, once for each time that an edge is missing its way back.
[[nodiscard]] std::vector<std::pair<int, int>> open_edges(
    const std::vector<std::array<int, 3>>& faces);

/// The same without the vertices that no side names; the others in the order in which sides do.
[[nodiscard]] Polyhedron without_unused_vertices(const Polyhedron& polyhedron);

/// The mean of the vertices: a point amid the solid, from where its numbers are small.
[[nodiscard]] Eigen::Vector3d vertex_mean(const std::vector<Eigen::Vector3d>& vertices);

/// Largest distance of a vertex from the mean of the vertices, m.
[[nodiscard]] double extent(const std::vector<Eigen::Vector3d>& vertices);

}  // namespace shapeid
