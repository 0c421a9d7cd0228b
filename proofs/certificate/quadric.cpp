#include "shapeid/proofs/certificate/quadric.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {
namespace {

using Corners = std::vector<Vector>;

/// x = origin + sum_k y_k directions_k.
struct Map {
  Vector origin;
  std::vector<Vector> directions;

  [[nodiscard]] Vector operator()(const Vector& y) const {
    Vector x = origin;
    for (std::size_t k = 0; k < y.size(); ++k) {
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += y[k] * directions[k][i];
    }
    return x;
  }
};

Vector times(const std::vector<Vector>& A, const Vector& x) {
  Vector y;
  for (const Vector& row : A) y.push_back(dot(row, x));
  return y;
}

/// The polynomial as one of y.
Quadric seen_through(const Quadric& q, const Map& map) {
  Quadric p;
  p.c = q.at(map.origin);
  const Vector At = times(q.A, map.origin);
  for (const Vector& d : map.directions) {
    p.b.emplace_back(dot(q.b, d) + 2 * dot(At, d));
    const Vector Ad = times(q.A, d);
    p.A.emplace_back();
    for (const Vector& e : map.directions) p.A.back().push_back(dot(Ad, e));
  }
  return p;
}

bool positive_definite(std::vector<Vector> A) {
  for (std::size_t k = 0; k < A.size(); ++k) {
    if (sgn(A[k][k]) <= 0) return false;
    for (std::size_t i = k + 1; i < A.size(); ++i) {
      const Rational factor = A[i][k] / A[k][k];
      for (std::size_t j = k; j < A.size(); ++j) A[i][j] -= factor * A[k][j];
    }
  }
  return true;
}

/// The minimum over all of space, if A is positive definite. Where it is not, a minimum over a
/// compact solid is also taken on its boundary.
std::optional<Lowest> lowest_anywhere(const Quadric& q) {
  if (!positive_definite(q.A)) return std::nullopt;
  Vector right;
  for (const Rational& b : q.b) right.emplace_back(-b / 2);
  const Vector x = solve(q.A, right);
  return Lowest{q.c + dot(q.b, x) / 2, x};
}

void keep_lower(std::optional<Lowest>& best, Lowest other) {
  if (!best || other.value < best->value) best = std::move(other);
}

Vector without(const Vector& v, std::size_t i) {
  Vector w = v;
  w.erase(w.begin() + static_cast<std::ptrdiff_t>(i));
  return w;
}

/// The face where coordinate i has this value.
Map face(std::size_t n, std::size_t i, const Rational& value) {
  Map map{Vector(n), {}};
  map.origin[i] = value;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == i) continue;
    map.directions.emplace_back(n);
    map.directions.back()[k] = 1;
  }
  return map;
}

Vector exact3(const Eigen::Vector3d& v) { return exact(Eigen::VectorXd(v)); }

Map map_of(const Eigen::Affine3d& frame) {
  Map map{exact3(frame.translation()), {}};
  for (int k = 0; k < 3; ++k) map.directions.push_back(exact3(frame.linear().col(k)));
  return map;
}

Lowest moved(Lowest lowest, const Map& map) {
  lowest.point = map(lowest.point);
  return lowest;
}

/// Corners of a polygon around the disc of this radius, proved to be outside of it.
std::vector<Vector> polygon_around(const Rational& radius) {
  constexpr int sides = 48;                   // its corners are 0.2 % outside
  constexpr double clear_of_rounding = 1e-9;  // so that the proof succeeds
  const double step = 2.0 * std::numbers::pi / sides;
  const double corner = (1.0 + clear_of_rounding) / std::cos(0.5 * step);
  std::vector<Vector> corners;
  for (int k = 0; k < sides; ++k) {
    corners.push_back(
        {radius * exact(corner * std::cos(k * step)), radius * exact(corner * std::sin(k * step))});
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const Rational x = b[0] - a[0], y = b[1] - a[1], area = a[0] * b[1] - a[1] * b[0];
    // The side's line is at the distance area / |b - a| from the centre.
    if (sgn(area) <= 0 || area * area < radius * radius * (x * x + y * y)) {
      throw std::logic_error("the polygon cuts its disc");
    }
  }
  return corners;
}

Corners prism_face(const std::vector<Vector>& polygon, std::size_t a, std::size_t b,
                   const Rational& z) {
  return {{0, 0, z}, {polygon[a][0], polygon[a][1], z}, {polygon[b][0], polygon[b][1], z}};
}

/// All triangles of the prism's surface.
std::vector<Corners> prism(const Rational& radius, const Rational& lower, const Rational& upper) {
  const std::vector<Vector> polygon = polygon_around(radius);
  std::vector<Corners> triangles;
  for (std::size_t a = 0; a < polygon.size(); ++a) {
    const std::size_t b = (a + 1) % polygon.size();
    const Corners low = prism_face(polygon, a, b, lower), high = prism_face(polygon, a, b, upper);
    triangles.push_back(low);
    triangles.push_back(high);
    triangles.push_back({low[1], low[2], high[1]});
    triangles.push_back({low[2], high[1], high[2]});
  }
  return triangles;
}

/// Over the solid that the triangles enclose, or below: a minimum in the inside is not asked
/// whether it lies there.
Lowest lowest_within(const Quadric& q, const std::vector<Corners>& surface) {
  std::optional<Lowest> best = lowest_anywhere(q);
  if (best) return *best;
  for (const Corners& triangle : surface) keep_lower(best, lowest_on_simplex(q, triangle));
  return *best;
}

bool inside(const std::vector<Corners>& surface, const Vector& x) {
  for (const Corners& t : surface) {
    const Vector &a = t[0], &b = t[1], &c = t[2];
    Vector u(3), v(3), w(3);
    for (std::size_t i = 0; i < 3; ++i) {
      u[i] = b[i] - a[i];
      v[i] = c[i] - a[i];
      w[i] = x[i] - a[i];
    }
    const Rational side = w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
                          w[2] * (u[0] * v[1] - u[1] * v[0]);
    if (sgn(side) > 0) return false;
  }
  return true;
}

struct LowestInShape {
  const Quadric& q;

  Lowest operator()(const Cuboid& s) const {
    const Map map = map_of(s.frame);
    return moved(lowest_in_box(seen_through(q, map), exact3(s.cell.lower), exact3(s.cell.upper)),
                 map);
  }
  Lowest operator()(const Cylinder& s) const {
    const Map map = map_of(s.frame);
    const Quadric p = seen_through(q, map);
    const Rational radius = exact(s.cell.upper.x());
    const auto middle = lowest_anywhere(p);
    if (middle && contains_in_prism(s.cell, radius, middle->point)) return moved(*middle, map);
    std::optional<Lowest> best;
    for (const Corners& t : prism(radius, exact(s.cell.lower.z()), exact(s.cell.upper.z()))) {
      keep_lower(best, lowest_on_simplex(p, t));
    }
    return moved(*best, map);
  }
  Lowest operator()(const Ellipsoid& s) const {
    const Map map = map_of(s.frame);
    return moved(lowest_in_ball(seen_through(q, map), exact(s.cell.upper.x())), map);
  }
  Lowest operator()(const Polyhedron& s) const {
    std::vector<Corners> surface;
    for (const auto& f : s.faces) {
      Corners corners;
      for (const int i : f) corners.push_back(exact3(s.vertices[static_cast<std::size_t>(i)]));
      surface.push_back(corners);
    }
    if (!s.convex) return lowest_within(q, surface);
    const auto middle = lowest_anywhere(q);
    if (middle && inside(surface, middle->point)) return *middle;
    std::optional<Lowest> best;
    for (const Corners& t : surface) keep_lower(best, lowest_on_simplex(q, t));
    return *best;
  }
  Lowest operator()(const Point& s) const {
    const Vector x = exact3(s.position);
    return {q.at(x), x};
  }

  static bool contains_in_prism(const Cell& cell, const Rational& radius, const Vector& x) {
    const Rational corner = radius * exact(1.01);  // beyond the prism's corners
    return x[0] * x[0] + x[1] * x[1] <= corner * corner && x[2] >= exact(cell.lower.z()) &&
           x[2] <= exact(cell.upper.z());
  }
};

}  // namespace

Rational Quadric::at(const Vector& x) const { return dot(times(A, x), x) + dot(b, x) + c; }

Quadric cost_of_point(const Vector& g) {
  const Rational xy = -g[5] / 2, xz = -g[6] / 2, yz = -g[8] / 2;
  return {{{g[7] + g[9], xy, xz}, {xy, g[4] + g[9], yz}, {xz, yz, g[4] + g[7]}},
          {g[1], g[2], g[3]},
          g[0]};
}

Lowest lowest_in_box(const Quadric& q, const Vector& lower, const Vector& upper) {
  const std::size_t n = q.size();
  if (n == 0) return {q.c, {}};
  std::optional<Lowest> best = lowest_anywhere(q);
  if (best) {
    bool is_inside = true;
    for (std::size_t i = 0; i < n; ++i) {
      is_inside = is_inside && lower[i] <= best->point[i] && best->point[i] <= upper[i];
    }
    if (is_inside) return *best;
    best.reset();
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (const Rational& end : {lower[i], upper[i]}) {
      const Map map = face(n, i, end);
      keep_lower(
          best,
          moved(lowest_in_box(seen_through(q, map), without(lower, i), without(upper, i)), map));
    }
  }
  return *best;
}

Lowest lowest_on_simplex(const Quadric& q, const std::vector<Vector>& corners) {
  if (corners.size() == 1) return {q.at(corners[0]), corners[0]};
  Map map{corners[0], {}};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    map.directions.push_back(corners[k]);
    for (std::size_t i = 0; i < corners[0].size(); ++i) map.directions.back()[i] -= corners[0][i];
  }
  if (const auto lowest = lowest_anywhere(seen_through(q, map))) {
    bool is_inside = sum(lowest->point) <= 1;
    for (const Rational& y : lowest->point) is_inside = is_inside && sgn(y) >= 0;
    if (is_inside) return moved(*lowest, map);
  }
  std::optional<Lowest> best;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    std::vector<Vector> others = corners;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    keep_lower(best, lowest_on_simplex(q, others));
  }
  return *best;
}

Lowest lowest_in_ball(const Quadric& q, const Rational& radius) {
  const auto is_zero = [](const Rational& entry) { return sgn(entry) == 0; };
  bool constant = std::all_of(q.b.begin(), q.b.end(), is_zero);
  for (const Vector& row : q.A) constant = constant && std::all_of(row.begin(), row.end(), is_zero);
  if (constant) return {q.c, Vector(q.size())};
  // For mu >= 0 and A + mu positive definite, q(x) >= q(x) + mu (|x|^2 - radius^2) >= its minimum
  // over all x, which is concave in mu.
  const auto with_multiplier = [&](double mu) -> std::optional<Lowest> {
    Quadric p = q;
    for (std::size_t i = 0; i < p.size(); ++i) p.A[i][i] += exact(mu);
    p.c -= exact(mu) * radius * radius;
    return lowest_anywhere(p);
  };
  Eigen::Matrix3d A;
  Eigen::Vector3d b;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    b[i] = q.b[row].get_d();
    for (int j = 0; j < 3; ++j) A(i, j) = q.A[row][static_cast<std::size_t>(j)].get_d();
  }
  // |x(mu)| falls with mu; the best mu is where it is the radius, or zero. Bracketed and halved.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  const Eigen::Vector3d along = eigen.eigenvectors().transpose() * b;
  const double R = radius.get_d(), size = A.norm() + b.norm() / R;
  constexpr double clear_of_rounding = 1e-12;  // of A's size: so that A + mu is definite
  double low = std::max(0.0, clear_of_rounding * size - eigen.eigenvalues()[0]);
  double high = low + size;
  const auto length = [&](double mu) {
    return (along.array() / (2.0 * (eigen.eigenvalues().array() + mu))).matrix().norm();
  };
  if (length(low) > R) {
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (length(middle) > R ? low : high) = middle;
    }
  }
  std::optional<Lowest> best;
  for (const double mu : {low, high, 2.0 * high, std::numeric_limits<double>::min()}) {
    if (!std::isfinite(mu)) continue;
    auto lowest = with_multiplier(mu);
    if (lowest && (!best || lowest->value > best->value)) best = std::move(lowest);
  }
  // 2 high is more than any eigenvalue; only numbers beyond doubles come here.
  if (!best) throw std::logic_error("no multiplier makes the polynomial convex");
  return *best;
}

Lowest lowest_in(const Quadric& q, const Shape& shape) {
  return std::visit(LowestInShape{q}, shape);
}

}  // namespace shapeid::certificate
