#include "shapeid/proofs/certificate/quadric.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {
namespace {

using Corners = std::vector<Vector>;

/// Triangles over corners that they share, counter-clockwise seen from outside.
struct Surface {
  Corners corners;
  std::vector<std::array<std::size_t, 3>> triangles;
};

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

/// The minimum over all of space, if A is positive definite. Where it is not, a minimum over a
/// compact solid is also taken on its boundary.
std::optional<Lowest> lowest_anywhere(const Quadric& q) {
  if (sign_of_form(q.A) != Sign::positive) return std::nullopt;
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

/// Of the largest coefficient, with coordinates in units of 2^length_unit; not all may be zero.
long exponent_of_largest(const Quadric& q, long length_unit) {
  Rational largest;
  for (const Rational& entry : q.b) largest = std::max(largest, scaled(abs(entry), length_unit));
  for (const Vector& row : q.A) {
    for (const Rational& entry : row) {
      largest = std::max(largest, scaled(abs(entry), 2 * length_unit));
    }
  }
  return exponent_of(largest);
}

/// Corners of a polygon around the disc of this radius, proved to be outside of it.
std::vector<Vector> polygon_around(const Rational& radius) {
  constexpr int sides = 48;                   // its corners are 0.2 % outside
  constexpr double clear_of_rounding = 1e-9;  // so that the proof succeeds
  const double step = 2.0 * std::numbers::pi / sides;
  const double corner = (1.0 + clear_of_rounding) / std::cos(0.5 * step);
  std::vector<Vector> corners;
  corners.reserve(sides);
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

/// The surface of the prism over such a polygon.
Surface prism(const Rational& radius, const Rational& lower, const Rational& upper) {
  const Corners polygon = polygon_around(radius);
  const std::size_t n = polygon.size();
  Surface surface;
  for (const Rational& z : {lower, upper}) {
    for (const Vector& corner : polygon) surface.corners.push_back({corner[0], corner[1], z});
  }
  for (std::size_t k = 1; k + 1 < n; ++k) {
    surface.triangles.push_back({0, k + 1, k});
    surface.triangles.push_back({n, n + k, n + k + 1});
  }
  for (std::size_t a = 0; a < n; ++a) {
    const std::size_t b = (a + 1) % n;
    surface.triangles.push_back({a, b, n + b});
    surface.triangles.push_back({a, n + b, n + a});
  }
  return surface;
}

Surface surface_of(const Polyhedron& s) {
  Surface surface;
  for (const Eigen::Vector3d& vertex : s.vertices) surface.corners.push_back(exact3(vertex));
  for (const auto& f : triangles(s)) {
    surface.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      surface.triangles.back()[i] = static_cast<std::size_t>(f[i]);
    }
  }
  return surface;
}

/// Where q is stationary on the flat that the corners span, if it has its minimum of the flat there
/// and that lies between the corners.
std::optional<Lowest> lowest_between(const Quadric& q, const Corners& corners) {
  Map map{corners[0], {}};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    map.directions.push_back(corners[k]);
    for (std::size_t i = 0; i < corners[0].size(); ++i) map.directions.back()[i] -= corners[0][i];
  }
  const auto lowest = lowest_anywhere(seen_through(q, map));
  if (!lowest || sum(lowest->point) > 1) return std::nullopt;
  for (const Rational& y : lowest->point) {
    if (sgn(y) < 0) return std::nullopt;
  }
  return moved(*lowest, map);
}

/// Every corner, edge and triangle once.
Lowest lowest_on(const Quadric& q, const Surface& surface) {
  std::optional<Lowest> best;
  for (const Vector& corner : surface.corners) keep_lower(best, {q.at(corner), corner});
  std::set<std::pair<std::size_t, std::size_t>> edges;
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    auto lowest =
        lowest_between(q, {surface.corners[t[0]], surface.corners[t[1]], surface.corners[t[2]]});
    if (lowest) keep_lower(best, std::move(*lowest));
  }
  for (const auto& [a, b] : edges) {
    auto lowest = lowest_between(q, {surface.corners[a], surface.corners[b]});
    if (lowest) keep_lower(best, std::move(*lowest));
  }
  return *best;
}

/// Whether x lies inside a convex surface, or on it.
bool inside(const Surface& surface, const Vector& x) {
  const Corners& corners = surface.corners;
  return std::ranges::all_of(surface.triangles, [&](const auto& t) {
    return sgn(side_of(corners[t[0]], corners[t[1]], corners[t[2]], x)) <= 0;
  });
}

/// Of the solid inside a convex surface.
Lowest lowest_within(const Quadric& q, const Surface& surface) {
  const auto middle = lowest_anywhere(q);
  return middle && inside(surface, middle->point) ? *middle : lowest_on(q, surface);
}

Rational determinant(const Vector& a, const Vector& b, const Vector& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// How often the surface winds around x, by the triangles that a ray from x crosses; empty if x is
/// on one of them, or the ray meets an edge.
std::optional<int> winding(const Surface& surface, const Vector& x, const Vector& ray) {
  int turns = 0;
  for (const auto& t : surface.triangles) {
    std::array<Vector, 3> from_x;
    for (std::size_t i = 0; i < 3; ++i) {
      from_x[i] = surface.corners[t[i]];
      for (std::size_t k = 0; k < 3; ++k) from_x[i][k] -= x[k];
    }
    const auto& [a, b, c] = from_x;
    const std::array<Rational, 3> sides = {determinant(ray, a, b), determinant(ray, b, c),
                                           determinant(ray, c, a)};
    const auto all = [&](int sign) {
      return std::all_of(sides.begin(), sides.end(),
                         [&](const Rational& side) { return sgn(side) == sign; });
    };
    const bool some_left =
        std::any_of(sides.begin(), sides.end(), [](const Rational& side) { return sgn(side) < 0; });
    const bool some_right =
        std::any_of(sides.begin(), sides.end(), [](const Rational& side) { return sgn(side) > 0; });
    if (some_left && some_right) continue;  // the line passes by
    if (!all(1) && !all(-1)) return std::nullopt;
    const int volume = sgn(determinant(a, b, c));
    if (volume == 0) return std::nullopt;
    const int side = sgn(sides[0]);
    if (volume == side) turns += side;  // ahead, not behind
  }
  return turns;
}

/// Of the solid inside any surface: that a file calls it convex proves nothing. Behind every face,
/// or where the surface winds around it, the minimum over all of space is one in the solid. Where
/// no ray tells, it counts: nothing in the solid is lower.
Lowest lowest_within_any(const Quadric& q, const Surface& surface) {
  const auto middle = lowest_anywhere(q);
  if (!middle) return lowest_on(q, surface);
  if (inside(surface, middle->point)) return *middle;
  // Directions that meet few edges.
  for (const auto& [u, v, w] : {std::array{1009, 2003, 3011}, std::array{-4001, 1523, 2111},
                                std::array{2617, -3203, 1709}, std::array{1153, 2731, -4513}}) {
    const std::optional<int> turns = winding(surface, middle->point, {u, v, w});
    if (turns) return *turns != 0 ? *middle : lowest_on(q, surface);
  }
  return *middle;
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
    const Surface around =
        prism(exact(s.cell.upper.x()), exact(s.cell.lower.z()), exact(s.cell.upper.z()));
    return moved(lowest_within(seen_through(q, map), around), map);
  }
  Lowest operator()(const Ellipsoid& s) const {
    const Map map = map_of(s.frame);
    return moved(lowest_in_ball(seen_through(q, map), exact(s.cell.upper.x())), map);
  }
  Lowest operator()(const Polyhedron& s) const { return lowest_within_any(q, surface_of(s)); }
  Lowest operator()(const Point& s) const {
    const Vector x = exact3(s.position);
    return {q.at(x), x};
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

std::optional<Rational> lowest_in_space(const Quadric& q) {
  // Homogeneous: (x, 1)^T [A, b/2; b^T/2, c] (x, 1).
  std::vector<Vector> form = q.A;
  for (std::size_t i = 0; i < q.size(); ++i) form[i].emplace_back(q.b[i] / 2);
  form.emplace_back();
  for (const Rational& b : q.b) form.back().emplace_back(b / 2);
  form.back().push_back(q.c);
  if (sign_of_form(std::move(form)) != Sign::indefinite) return Rational(0);
  const auto lowest = lowest_anywhere(q);
  return lowest ? std::optional(lowest->value) : std::nullopt;
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

Lowest lowest_in_ball(const Quadric& q, const Rational& radius) {
  const auto is_zero = [](const Rational& entry) { return sgn(entry) == 0; };
  bool constant = std::all_of(q.b.begin(), q.b.end(), is_zero);
  for (const Vector& row : q.A) constant = constant && std::all_of(row.begin(), row.end(), is_zero);
  if (constant) return {q.c, Vector(q.size())};
  // For mu >= 0 and A + mu positive definite, q(x) >= q(x) + mu (|x|^2 - radius^2) >= its minimum
  // over all x, which is concave in mu.
  // Doubles see it in units of about the radius and about its largest coefficient: the slopes of
  // what a stranger states may be beyond doubles.
  const long length_unit = exponent_of(radius), unit = exponent_of_largest(q, length_unit);
  const long multiplier_unit = unit - 2 * length_unit;
  const auto with_multiplier = [&](double mu) -> std::optional<Lowest> {
    const Rational multiplier = scaled(exact(mu), multiplier_unit);
    Quadric p = q;
    for (std::size_t i = 0; i < p.size(); ++i) p.A[i][i] += multiplier;
    p.c -= multiplier * radius * radius;
    return lowest_anywhere(p);
  };
  Eigen::Matrix3d A;
  Eigen::Vector3d b;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<std::size_t>(i);
    b[i] = scaled(q.b[row], length_unit - unit).get_d();
    for (int j = 0; j < 3; ++j) {
      A(i, j) = scaled(q.A[row][static_cast<std::size_t>(j)], -multiplier_unit).get_d();
    }
  }
  // |x(mu)| falls with mu; the best mu is where it is the radius, or zero. Bracketed and halved.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(A);
  const Eigen::Vector3d along = eigen.eigenvectors().transpose() * b;
  const double R = scaled(radius, -length_unit).get_d(), size = A.norm() + b.norm() / R;
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
  for (const double mu : {low, high, 2.0 * high}) {
    auto lowest = with_multiplier(mu);
    if (lowest && (!best || lowest->value > best->value)) best = std::move(lowest);
  }
  // 2 high is more than any eigenvalue.
  if (!best) throw std::logic_error("no multiplier makes the polynomial convex");
  return *best;
}

Lowest lowest_in(const Quadric& q, const Shape& shape) {
  return std::visit(LowestInShape{q}, shape);
}

}  // namespace shapeid::certificate
