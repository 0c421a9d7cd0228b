// Shapes of uniform density: canonical bodies, cells of them, and the maps that carry them.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bodies.hpp"
#include "json.hpp"

namespace example {

/// A uniform solid of unit mass.
struct Solid {
  double volume;
  Sigma moments;
};

/// A cell between bounds of the coordinates of its canonical body (cuboid: x, y, z in [-1/2, 1/2];
/// cylinder: r in [0, 1], angle, z in [-1/2, 1/2]; ellipsoid: r in [0, 1], polar angle, azimuth),
/// stretched and placed by a map.
struct Cell {
  std::string kind;
  Eigen::Vector3d lower, upper, stretch;
  Eigen::Matrix4d placement;
};

inline constexpr double pi = 3.14159265358979323846;

inline Cell cell(const Json& shape) {
  Cell c{shape["kind"].text, {}, {}, {}, pose(shape["xyz"].numbers(), shape["rpy"].numbers())};
  if (c.kind == "cuboid") {
    c.stretch = shape["size"].numbers();
    c.lower.setConstant(-0.5);
    c.upper.setConstant(0.5);
  } else if (c.kind == "cylinder") {
    const double r = shape["radius"].number();
    c.stretch = Eigen::Vector3d(r, r, shape["length"].number());
    c.lower = Eigen::Vector3d(0.0, 0.0, -0.5);
    c.upper = Eigen::Vector3d(1.0, 2.0 * pi, 0.5);
  } else {
    c.stretch = shape["semi_axes"].numbers();
    c.lower.setZero();
    c.upper = Eigen::Vector3d(1.0, pi, 2.0 * pi);
  }
  if (shape.has("lower")) c.lower = shape["lower"].numbers();
  if (shape.has("upper")) c.upper = shape["upper"].numbers();
  return c;
}

/// Integral of x^power.
inline double integral(int power, double a, double b) {
  return (std::pow(b, power + 1) - std::pow(a, power + 1)) / (power + 1);
}

/// Means of (1, x, x^2) with weight x^power, the first replaced by the weight's integral.
inline Eigen::Vector3d radial(int power, double a, double b) {
  const double size = integral(power, a, b);
  return {size, integral(power + 1, a, b) / size, integral(power + 2, a, b) / size};
}

/// Means of (u, 1)(u, 1)^T over the arc u = (cos t, sin t).
inline Eigen::Matrix3d arc(double a, double b) {
  const double w = b - a, c = (std::sin(b) - std::sin(a)) / w, s = (std::cos(a) - std::cos(b)) / w,
               twice = (std::sin(2.0 * b) - std::sin(2.0 * a)) / (4.0 * w),
               cs = (std::cos(2.0 * a) - std::cos(2.0 * b)) / (4.0 * w);
  Eigen::Matrix3d M;
  M << 0.5 + twice, cs, c, cs, 0.5 - twice, s, c, s, 1.0;
  return M;
}

/// Points (p u, z) with u on an arc, independent of (p, z): means of (x, 1)(x, 1)^T.
inline Sigma swept(const Eigen::Matrix3d& u, double p, double pp, double z, double pz, double zz) {
  Eigen::Matrix4d M;
  M.topLeftCorner<2, 2>() = pp * u.topLeftCorner<2, 2>();
  M.block<2, 1>(0, 2) = pz * u.topRightCorner<2, 1>();
  M.block<2, 1>(0, 3) = p * u.topRightCorner<2, 1>();
  M.bottomRightCorner<2, 2>() << zz, z, z, 1.0;
  M.bottomLeftCorner<2, 2>() = M.topRightCorner<2, 2>().transpose().eval();
  return M;
}

/// Volume and means of a cell in canonical coordinates.
inline Solid canonical(const Cell& cell) {
  const Eigen::Vector3d &a = cell.lower, &b = cell.upper, w = b - a;
  if (cell.kind == "cuboid") {
    const Eigen::Vector3d c = 0.5 * (a + b);
    const Eigen::Matrix3d spread = (w.cwiseAbs2() / 12.0).asDiagonal();
    return {w.prod(), body(1.0, c, c * c.transpose() + spread)};
  }
  if (cell.kind == "cylinder") {
    const Eigen::Vector3d r = radial(1, a[0], b[0]), z = radial(0, a[2], b[2]);
    return {r[0] * w[1] * z[0], swept(arc(a[1], b[1]), r[1], r[2], z[1], r[1] * z[1], z[2])};
  }
  // The weight sin t of the polar angle t is the even weight of q = cos t.
  const Eigen::Vector3d r = radial(2, a[0], b[0]);
  const Eigen::Vector3d q = radial(0, std::cos(b[1]), std::cos(a[1]));
  const double sine = 0.5 * (w[1] - 0.5 * (std::sin(2.0 * b[1]) - std::sin(2.0 * a[1]))) / q[0];
  const double sine_q = integral(2, std::sin(a[1]), std::sin(b[1])) / q[0];
  return {r[0] * q[0] * w[2], swept(arc(a[2], b[2]), r[1] * sine, r[2] * (1.0 - q[2]), r[1] * q[1],
                                    r[2] * sine_q, r[2] * q[2])};
}

inline Solid solid(const Cell& cell) {
  const Solid own = canonical(cell);
  Eigen::Matrix4d stretch = Eigen::Matrix4d::Identity();
  stretch.diagonal().head<3>() = cell.stretch;
  return {cell.stretch.prod() * own.volume, mapped(cell.placement * stretch, own.moments)};
}

/// Signed tetrahedra between the triangles and the origin.
inline Solid closed_surface(const std::vector<Eigen::Vector3d>& p,
                            const std::vector<std::array<std::size_t, 3>>& faces) {
  double volume = 0.0;
  Sigma sum = Sigma::Zero();
  for (const auto& face : faces) {
    const Eigen::Vector3d &a = p[face[0]], &b = p[face[1]], &c = p[face[2]], g = a + b + c;
    const double V = a.dot(b.cross(c)) / 6.0;
    const Eigen::Matrix3d S =
        g * g.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose();
    volume += V;
    sum += V * body(1.0, g / 4.0, S / 20.0);
  }
  return {std::abs(volume), sum / volume};
}

inline Solid solid(const Json& shape) {
  if (!shape.has("vertices")) return solid(cell(shape));
  std::vector<Eigen::Vector3d> corners;
  for (const Json& corner : shape["vertices"].items) corners.emplace_back(corner.numbers());
  std::vector<std::array<std::size_t, 3>> faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  if (shape.has("faces")) {
    faces.clear();
    for (const Json& face : shape["faces"].items) {
      const auto corner = [&](std::size_t i) {
        return static_cast<std::size_t>(face.items[i].integer());
      };
      faces.push_back({corner(0), corner(1), corner(2)});
    }
  }
  const Solid own = closed_surface(corners, faces);
  return {own.volume, mapped(pose(shape["xyz"].numbers(), shape["rpy"].numbers()), own.moments)};
}

/// The lower part holds `fraction` of the volume.
inline std::pair<Cell, Cell> cut(const Cell& whole, int axis, double fraction) {
  const double a = whole.lower[axis], b = whole.upper[axis];
  const auto between = [&](double x, double y) { return x + fraction * (y - x); };
  double at = between(a, b);
  if (whole.kind == "cylinder" && axis == 0) at = std::sqrt(between(a * a, b * b));
  if (whole.kind == "ellipsoid" && axis == 0) at = std::cbrt(between(a * a * a, b * b * b));
  if (whole.kind == "ellipsoid" && axis == 1) at = std::acos(between(std::cos(a), std::cos(b)));
  std::pair<Cell, Cell> parts{whole, whole};
  parts.first.upper[axis] = parts.second.lower[axis] = at;
  return parts;
}

/// A cuboid across its longest side; of sides that tie, the first.
inline std::pair<Cell, Cell> halves(const Cell& cuboid) {
  const Eigen::Vector3d sides = (cuboid.upper - cuboid.lower).cwiseProduct(cuboid.stretch);
  int axis = 0;
  while (sides[axis] < (1.0 - 1e-9) * sides.maxCoeff()) ++axis;
  return cut(cuboid, axis, 0.5);
}

}  // namespace example
