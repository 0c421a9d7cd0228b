// Cutting a convex solid by a plane, and finding the plane that leaves a given volume below it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "shapeid/models/polyhedron.hpp"

namespace shapeid {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Builds the part of `whole` whose vertices have negative height. Sides are clipped whole, not in
/// triangles: the next cut would meet the edges between those and leave corners on them.
class Clipper {
 public:
  Clipper(const Polyhedron& whole, const std::vector<double>& height)
      : whole_(whole), height_(height), copy_of_(whole.vertices.size(), -1) {}

  Polyhedron clip() {
    for (const std::vector<int>& side : whole_.sides) clip_side(side);
    close();
    drop_vertices_of_two_sides();
    return without_unused_vertices(part_);
  }

 private:
  [[nodiscard]] double height(int v) const { return height_[static_cast<std::size_t>(v)]; }

  /// The part's own index for a vertex of the whole; its coordinates are copied bit by bit.
  int copy(int v) {
    int& index = copy_of_[static_cast<std::size_t>(v)];
    if (index < 0) index = add(whole_.vertices[static_cast<std::size_t>(v)]);
    return index;
  }

  /// Where edge ab meets the plane: once for both sides of the edge, and computed from its lower
  /// vertex, so that the parts on both sides agree to the last bit.
  int crossing(int a, int b) {
    const std::pair<int, int> edge = std::minmax(a, b);
    const auto found = crossing_of_.find(edge);
    if (found != crossing_of_.end()) return found->second;
    const Eigen::Vector3d& from = whole_.vertices[static_cast<std::size_t>(edge.first)];
    const Eigen::Vector3d& to = whole_.vertices[static_cast<std::size_t>(edge.second)];
    const double t = height(edge.first) / (height(edge.first) - height(edge.second));
    return crossing_of_[edge] = add(from + t * (to - from));
  }

  int add(const Eigen::Vector3d& vertex) {
    part_.vertices.push_back(vertex);
    return static_cast<int>(part_.vertices.size()) - 1;
  }

  void clip_side(const std::vector<int>& side) {
    // A side that only touches the plane from above leaves nothing.
    if (std::none_of(side.begin(), side.end(), [&](int v) { return height(v) < 0.0; })) return;
    std::vector<int> clipped;
    for (std::size_t i = 0; i < side.size(); ++i) {
      const int a = side[i];
      const int b = side[(i + 1) % side.size()];
      if (height(a) <= 0.0) clipped.push_back(copy(a));
      if ((height(a) < 0.0 && height(b) > 0.0) || (height(a) > 0.0 && height(b) < 0.0)) {
        clipped.push_back(crossing(a, b));
      }
    }
    part_.sides.push_back(std::move(clipped));
  }

  /// The edges that clipping left open run around the section. Closing follows them backwards, by
  /// index alone: whatever the roundings are, the result is closed.
  void close() {
    std::multimap<int, int> next;
    for (const auto& [a, b] : open_edges(triangles(part_))) next.emplace(b, a);
    while (!next.empty()) {
      std::vector<int> loop = {next.begin()->first};
      for (auto step = next.find(loop.back()); step != next.end(); step = next.find(loop.back())) {
        loop.push_back(step->second);
        next.erase(step);
      }
      loop.pop_back();  // the first vertex again
      part_.sides.push_back(std::move(loop));
    }
  }

  /// A side that rounding leaves in the plane but for a corner has edge after edge in common with
  /// the section, and no third side ends between these. Both go without such vertices, which moves
  /// the surface by roundings.
  void drop_vertices_of_two_sides() {
    std::vector<int> sides_at(part_.vertices.size(), 0);
    for (const std::vector<int>& side : part_.sides) {
      for (const int v : side) ++sides_at[static_cast<std::size_t>(v)];
    }
    for (std::vector<int>& side : part_.sides) {
      std::erase_if(side, [&](int v) { return sides_at[static_cast<std::size_t>(v)] == 2; });
    }
  }

  const Polyhedron& whole_;
  const std::vector<double>& height_;
  std::vector<int> copy_of_;
  std::map<std::pair<int, int>, int> crossing_of_;
  Polyhedron part_;
};

/// What lies below a plane: its volume, m^3, and the area of the section that bounds it, m^2.
struct Below {
  double volume;
  double section;
};

/// Without building the part. Seen from a point of the plane the section adds no volume; and the
/// area vectors of a closed surface sum to zero, so that the other sides tell the section's.
Below below(const Polyhedron& whole, const std::vector<double>& height, double level,
            const Eigen::Vector3d& direction, const Eigen::Vector3d& on_plane) {
  double six = 0.0;
  Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> clipped;
  for (const std::vector<int>& side : whole.sides) {
    clipped.clear();
    for (std::size_t i = 0; i < side.size(); ++i) {
      const auto a = static_cast<std::size_t>(side[i]);
      const auto b = static_cast<std::size_t>(side[(i + 1) % side.size()]);
      const double from = height[a] - level;
      const double to = height[b] - level;
      const Eigen::Vector3d corner = whole.vertices[a] - on_plane;
      if (from < 0.0) clipped.push_back(corner);
      if ((from < 0.0) != (to < 0.0)) {
        clipped.push_back(corner + from / (from - to) * (whole.vertices[b] - whole.vertices[a]));
      }
    }
    for (std::size_t i = 2; i < clipped.size(); ++i) {
      const Eigen::Vector3d triangle = (clipped[i - 1] - clipped[0]).cross(clipped[i] - clipped[0]);
      six += clipped[0].dot(triangle);
      twice_area += triangle;
    }
  }
  return {six / 6.0, -0.5 * direction.dot(twice_area)};
}

/// Heights of vertices above a plane, zero where the distance is no more than their own rounding.
std::vector<double> above(const std::vector<double>& height, double level, double rounding) {
  std::vector<double> result(height.size());
  std::transform(height.begin(), height.end(), result.begin(),
                 [&](double h) { return std::abs(h - level) <= rounding ? 0.0 : h - level; });
  return result;
}

}  // namespace

std::optional<std::pair<Polyhedron, Polyhedron>> cut(const Polyhedron& p,
                                                     const Eigen::Vector3d& direction,
                                                     double fraction) {
  const Eigen::Vector3d o = vertex_mean(p.vertices);
  std::vector<double> height;
  double reach = 0.0;
  for (const Eigen::Vector3d& v : p.vertices) {
    height.push_back(direction.dot(v - o));
    reach = std::max(reach, v.cwiseAbs().maxCoeff());
  }
  const double rounding = 2.0 * eps * reach;
  const auto [lowest, highest] = std::minmax_element(height.begin(), height.end());
  double low = *lowest;
  double high = *highest;
  const double volume = moments(p).volume;

  // The volume below a level grows monotonically, cubic between levels of vertices, and its
  // derivative is the section's area. Newton's steps, and halving where they leave the bracket or
  // do not halve the last step (at an apex they only shrink by a third), so that few are needed.
  constexpr int most_steps = 200;
  double level = low + fraction * (high - low);
  double last_step = high - low;
  for (int i = 0; i < most_steps; ++i) {
    const Below held = below(p, height, level, direction, o + level * direction);
    const double excess = held.volume - fraction * volume;
    if (std::abs(excess) <= eps * volume) break;
    (excess > 0.0 ? high : low) = level;
    double next = level - excess / held.section;
    if (!(low < next && next < high) || std::abs(next - level) > 0.5 * std::abs(last_step)) {
      next = 0.5 * (low + high);
    }
    last_step = next - level;
    if (std::abs(last_step) <= 0.5 * rounding) break;
    level = next;
  }

  std::vector<double> upward = above(height, level, rounding);
  Polyhedron lower = Clipper(p, upward).clip();
  for (double& h : upward) h = -h;
  Polyhedron upper = Clipper(p, upward).clip();
  if (why_malformed(lower) || why_malformed(upper)) return std::nullopt;
  return std::pair(std::move(lower), std::move(upper));
}

}  // namespace shapeid
