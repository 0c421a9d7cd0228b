#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "shapeid/models/polyhedron.hpp"

namespace shapeid {
namespace {

/// Signed solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Distance of the origin from the segment ab.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double t = along.isZero(0.0) ? 0.0 : -a.dot(along) / along.squaredNorm();
  return (a + std::clamp(t, 0.0, 1.0) * along).norm();
}

/// Distance of the origin from the triangle abc.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const bool above = n.dot(a.cross(b)) > 0.0 && n.dot(b.cross(c)) > 0.0 && n.dot(c.cross(a)) > 0.0;
  if (above) return std::abs(n.dot(a)) / n.norm();
  return std::min({distance(a, b), distance(b, c), distance(c, a)});
}

}  // namespace

double winding(const Polyhedron& p, const Eigen::Vector3d& point) {
  constexpr double sphere = 4.0 * std::numbers::pi;
  double wound = 0.0;
  for (const auto& face : triangles(p)) {
    const auto [a, b, c] = corners(p, face, point);
    wound += solid_angle(a, b, c);
  }
  return wound / sphere;
}

bool contains(const Polyhedron& p, const Eigen::Vector3d& point, double slack) {
  constexpr double inside = 0.5;
  if (winding(p, point) > inside) return true;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& face : triangles(p)) {
    const auto [a, b, c] = corners(p, face, point);
    nearest = std::min(nearest, distance(a, b, c));
  }
  return nearest <= slack;
}

}  // namespace shapeid
