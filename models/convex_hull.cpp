// The convex hull of points: one point after the other, each joined to the rim of what it sees.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "shapeid/models/polyhedron.hpp"

namespace shapeid {
namespace {

using Points = std::vector<Eigen::Vector3d>;
using Face = std::array<int, 3>;

/// Every point is held against every face, so a mesh of a million triangles needs an end. No part
/// of a robot is that round.
constexpr std::size_t most_faces = 5000;

class Hull {
 public:
  explicit Hull(Points points) : points_(std::move(points)) {
    if (points_.size() < 4) refuse();
    // Roundings of the coordinates, and of the few products behind a height.
    flat_ = 16.0 * std::numeric_limits<double>::epsilon() *
            (vertex_mean(points_).norm() + extent(points_));
    start();
    for (int i = 0; i < static_cast<int>(points_.size()); ++i) add(i);
  }

  /// The hull's faces, on the points that they use.
  [[nodiscard]] Polyhedron polyhedron() const {
    Polyhedron result{points_, {}};
    for (const Face& face : faces_) result.sides.emplace_back(face.begin(), face.end());
    return without_unused_vertices(result);
  }

 private:
  [[noreturn]] static void refuse() {
    throw std::invalid_argument("the points span no solid: they lie in a plane, or on a line");
  }

  [[nodiscard]] const Eigen::Vector3d& at(int i) const {
    return points_[static_cast<std::size_t>(i)];
  }

  [[nodiscard]] Eigen::Vector3d normal(const Face& f) const {
    return (at(f[1]) - at(f[0])).cross(at(f[2]) - at(f[0])).normalized();
  }

  [[nodiscard]] double height(const Face& f, const Eigen::Vector3d& p) const {
    return normal(f).dot(p - at(f[0]));
  }

  template <typename Measure>
  [[nodiscard]] int farthest(Measure measure) const {
    const auto best =
        std::max_element(points_.begin(), points_.end(),
                         [&](const auto& a, const auto& b) { return measure(a) < measure(b); });
    if (!(measure(*best) > flat_)) refuse();
    return static_cast<int>(best - points_.begin());
  }

  /// A tetrahedron of points far from each other.
  void start() {
    const Eigen::Vector3d mean = vertex_mean(points_);
    const int a = farthest([&](const Eigen::Vector3d& p) { return (p - mean).norm(); });
    const int b = farthest([&](const Eigen::Vector3d& p) { return (p - at(a)).norm(); });
    const Eigen::Vector3d ab = (at(b) - at(a)).normalized();
    const int c = farthest([&](const Eigen::Vector3d& p) { return ab.cross(p - at(a)).norm(); });
    const Face base = {a, b, c};
    const int d = farthest([&](const Eigen::Vector3d& p) { return std::abs(height(base, p)); });
    faces_ = {base, {a, c, d}, {c, b, d}, {b, a, d}};
    if (height(base, at(d)) > 0.0) {
      for (Face& face : faces_) std::swap(face[0], face[1]);
    }
  }

  void add(int i) {
    const Eigen::Vector3d& p = at(i);
    std::vector<double> heights;
    for (const Face& face : faces_) heights.push_back(height(face, p));
    if (*std::max_element(heights.begin(), heights.end()) <= flat_) return;

    // Faces in whose plane the point lies go as well: joined to the rim of their facet, it makes
    // triangles that are never degenerate, and facets never keep points that are not corners.
    std::vector<Face> seen;
    std::vector<Face> kept;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      (heights[f] >= -flat_ ? seen : kept).push_back(faces_[f]);
    }
    for (const auto& [a, b] : open_edges(seen)) kept.push_back({a, b, i});
    if (kept.size() > most_faces) {
      throw std::invalid_argument(
          fmt::format("the hull has more than {} faces; simplify it", most_faces));
    }
    faces_ = std::move(kept);
  }

  Points points_;
  double flat_ = 0.0;  ///< m: heights that count as zero
  std::vector<Face> faces_;
};

}  // namespace

Shape make_convex_hull(const Points& points, const Eigen::Isometry3d& pose) {
  Points placed;
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) throw std::invalid_argument("a point of the hull is not finite");
    placed.push_back(pose * p);
  }
  Polyhedron hull = Hull(std::move(placed)).polyhedron();
  if (why_malformed(hull) || !is_convex(hull)) {
    throw std::invalid_argument(
        "the points are too nearly in a plane for a hull in double precision");
  }
  return hull;
}

}  // namespace shapeid
