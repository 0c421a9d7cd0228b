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

/// A part and the area of the plane section that closes it, m^2.
struct Part {
  Polyhedron solid;
  double section = 0.0;
};

/// Builds the part of `whole` whose vertices have negative height.
class Clipper {
 public:
  Clipper(const Polyhedron& whole, const std::vector<double>& height)
      : whole_(whole), height_(height), copy_of_(whole.vertices.size(), -1) {}

  Part clip() {
    for (const auto& face : whole_.faces) clip_face(face);
    close();
    return std::move(part_);
  }

 private:
  [[nodiscard]] double height(int v) const { return height_[static_cast<std::size_t>(v)]; }

  /// The part's own index for a vertex of the whole; its coordinates are copied bit by bit.
  int copy(int v) {
    int& index = copy_of_[static_cast<std::size_t>(v)];
    if (index < 0) index = add(whole_.vertices[static_cast<std::size_t>(v)]);
    return index;
  }

  /// Where edge ab meets the plane: once for both faces of the edge, and computed from its lower
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
    part_.solid.vertices.push_back(vertex);
    return static_cast<int>(part_.solid.vertices.size()) - 1;
  }

  void clip_face(const std::array<int, 3>& face) {
    // A face that only touches the plane from above leaves nothing.
    if (std::none_of(face.begin(), face.end(), [&](int v) { return height(v) < 0.0; })) return;
    std::vector<int> polygon;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = face[i];
      const int b = face[(i + 1) % 3];
      if (height(a) <= 0.0) polygon.push_back(copy(a));
      if ((height(a) < 0.0 && height(b) > 0.0) || (height(a) > 0.0 && height(b) < 0.0)) {
        polygon.push_back(crossing(a, b));
      }
    }
    fan(polygon);
  }

  void fan(const std::vector<int>& polygon) {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      part_.solid.faces.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
  }

  /// The edges that clipping left open run around the section. Closing follows them backwards, by
  /// index alone: whatever the roundings are, the result is closed.
  void close() {
    std::multimap<int, int> next;
    for (const auto& [a, b] : open_edges(part_.solid.faces)) next.emplace(b, a);
    while (!next.empty()) {
      std::vector<int> loop = {next.begin()->first};
      for (auto step = next.find(loop.back()); step != next.end(); step = next.find(loop.back())) {
        loop.push_back(step->second);
        next.erase(step);
      }
      loop.pop_back();  // the first vertex again
      fan(loop);
      part_.section += area(loop);
    }
  }

  [[nodiscard]] double area(const std::vector<int>& loop) const {
    const auto at = [&](int v) -> const Eigen::Vector3d& {
      return part_.solid.vertices[static_cast<std::size_t>(v)];
    };
    Eigen::Vector3d twice = Eigen::Vector3d::Zero();
    for (std::size_t i = 2; i < loop.size(); ++i) {
      twice += (at(loop[i - 1]) - at(loop[0])).cross(at(loop[i]) - at(loop[0]));
    }
    return 0.5 * twice.norm();
  }

  const Polyhedron& whole_;
  const std::vector<double>& height_;
  std::vector<int> copy_of_;
  std::map<std::pair<int, int>, int> crossing_of_;
  Part part_;
};

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
  const auto below = [&](double level) {
    return Clipper(p, above(height, level, rounding)).clip();
  };
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
    const Part part = below(level);
    const double held = part.solid.faces.empty() ? 0.0 : moments(part.solid).volume;
    const double excess = held - fraction * volume;
    if (std::abs(excess) <= eps * volume) break;
    (excess > 0.0 ? high : low) = level;
    double next = level - excess / part.section;
    if (!(low < next && next < high) || std::abs(next - level) > 0.5 * std::abs(last_step)) {
      next = 0.5 * (low + high);
    }
    last_step = next - level;
    if (std::abs(last_step) <= 0.5 * rounding) break;
    level = next;
  }

  std::vector<double> upward = above(height, level, rounding);
  Part lower = Clipper(p, upward).clip();
  for (double& h : upward) h = -h;
  Part upper = Clipper(p, upward).clip();
  if (why_malformed(lower.solid) || why_malformed(upper.solid)) return std::nullopt;
  return std::pair(std::move(lower.solid), std::move(upper.solid));
}

}  // namespace shapeid
