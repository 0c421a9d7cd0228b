#include "shapeid/proofs/certificate/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/exact_moments.hpp"
#include "shapeid/proofs/certificate/linear.hpp"

namespace shapeid::certificate {
namespace {

Vector exact3(const Eigen::Vector3d& x) { return exact(Eigen::VectorXd(x)); }

/// Why the column is not the shape's; empty if it is.
std::string disagreement(const MassProblem& p, Eigen::Index j, const Region& region,
                         const Rational& rounding) {
  const auto moments = exact_moments(region.shape);
  if (!moments) return fmt::format("the shape of column {} cannot be integrated", j);
  const std::array<Enclosure, 10>& u = moments->parameters;
  const Rational square = (u[4].lower + u[7].lower + u[9].lower) / 2;  // of the distance, mean
  if (distance(exact(p.V[j]), moments->volume) > rounding * moments->volume.lower) {
    return fmt::format("volume {} is said to be {}, its shape has {}", j, p.V[j],
                       moments->volume.lower.get_d());
  }
  for (Eigen::Index i = 0; i < p.U.rows(); ++i) {
    const Eigen::Index k = i - 10 * region.link;
    const double written = p.U(i, j);
    if (k < 0 || k >= 10) {
      if (written != 0.0) return fmt::format("column {} has entries on other links", j);
      continue;
    }
    const Enclosure& made = u[static_cast<std::size_t>(k)];
    const Rational off = distance(exact(written), made);
    const bool agrees = k == 0  ? off <= rounding
                        : k < 4 ? off * off <= rounding * rounding * square
                                : off <= rounding * square;
    if (!agrees) {
      return fmt::format("{} of column {} of U is said to be {}, its shape has {}",
                         parameter_names[static_cast<std::size_t>(k)], j, written,
                         made.lower.get_d());
    }
  }
  return "";
}

/// Corners whose convex hull the shape is; none for curved shapes.
struct Corners {
  std::vector<Vector> operator()(const Cuboid& s) const {
    std::vector<Vector> corners;
    for (int corner = 0; corner < 8; ++corner) {
      Vector x = exact3(s.frame.translation());
      for (int axis = 0; axis < 3; ++axis) {
        const double end = (corner >> axis) % 2 == 0 ? s.cell.lower[axis] : s.cell.upper[axis];
        for (std::size_t i = 0; i < 3; ++i) {
          x[i] += exact(s.frame(static_cast<Eigen::Index>(i), axis)) * exact(end);
        }
      }
      corners.push_back(std::move(x));
    }
    return corners;
  }
  std::vector<Vector> operator()(const Polyhedron& s) const {
    std::vector<Vector> corners;
    for (const Eigen::Vector3d& vertex : s.vertices) corners.push_back(exact3(vertex));
    return corners;
  }
  std::vector<Vector> operator()(const Point& s) const { return {exact3(s.position)}; }
  std::vector<Vector> operator()(const Cylinder&) const { return {}; }
  std::vector<Vector> operator()(const Ellipsoid&) const { return {}; }
};

/// Whether a convex region, widened by `rounding`, holds a point. Sectors hold none.
struct Holds {
  Vector x;
  Rational rounding;

  /// Coordinates in the canonical body; none if a frame that is singular in exact arithmetic,
  /// though not in doubles, gives the point none.
  [[nodiscard]] std::optional<Vector> seen_in(const Eigen::Affine3d& frame) const {
    std::vector<Vector> L;
    Vector right;
    for (Eigen::Index i = 0; i < 3; ++i) {
      L.push_back(exact(Eigen::VectorXd(frame.linear().row(i).transpose())));
      right.emplace_back(x[static_cast<std::size_t>(i)] - exact(frame.translation()[i]));
    }
    Vector seen = solve(L, right);
    for (std::size_t i = 0; i < 3; ++i) {
      if (dot(L[i], seen) != right[i]) return std::nullopt;
    }
    return seen;
  }
  [[nodiscard]] bool between(const Rational& y, double lower, double upper) const {
    const Rational slack = rounding * (exact(upper) - exact(lower));
    return exact(lower) - slack <= y && y <= exact(upper) + slack;
  }
  [[nodiscard]] bool within(const Rational& square, double radius) const {
    const Rational R = exact(radius) * (1 + rounding);
    return square <= R * R;
  }
  static bool whole_turn(double lower, double upper) {
    return upper - lower >= 2.0 * std::numbers::pi;
  }

  bool operator()(const Cuboid& s) const {
    const auto y = seen_in(s.frame);
    if (!y) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      if (!between((*y)[i], s.cell.lower[axis], s.cell.upper[axis])) return false;
    }
    return true;
  }
  bool operator()(const Cylinder& s) const {
    if (s.cell.lower.x() > 0.0 || !whole_turn(s.cell.lower.y(), s.cell.upper.y())) return false;
    const auto seen = seen_in(s.frame);
    if (!seen) return false;
    const Vector& y = *seen;
    return between(y[2], s.cell.lower.z(), s.cell.upper.z()) &&
           within(y[0] * y[0] + y[1] * y[1], s.cell.upper.x());
  }
  bool operator()(const Ellipsoid& s) const {
    const bool whole = s.cell.lower.x() == 0.0 && s.cell.lower.y() == 0.0 &&
                       s.cell.upper.y() >= std::numbers::pi &&
                       whole_turn(s.cell.lower.z(), s.cell.upper.z());
    const auto y = seen_in(s.frame);
    return whole && y && within(dot(*y, *y), s.cell.upper.x());
  }
  bool operator()(const Polyhedron& s) const {
    if (!s.convex) return false;
    // Toward a point inside by `rounding` of the way. A vertex of no face need not be of the solid.
    const auto faces = triangles(s);
    Vector inner(3), y = x;
    for (const auto& face : faces) {
      for (const auto place : face) {
        const Vector corner = exact3(s.vertices[static_cast<std::size_t>(place)]);
        for (std::size_t i = 0; i < 3; ++i) inner[i] += corner[i] / Rational(3 * faces.size());
      }
    }
    for (std::size_t i = 0; i < 3; ++i) y[i] += rounding * (inner[i] - x[i]);
    for (const auto& face : faces) {
      const auto corner = [&](std::size_t i) {
        return exact3(s.vertices[static_cast<std::size_t>(face[i])]);
      };
      if (sgn(side_of(corner(0), corner(1), corner(2), y)) > 0) return false;
    }
    return true;
  }
  bool operator()(const Point& s) const { return x == exact3(s.position); }
};

/// Whether part and whole are cells of the same body, and the part's bounds lie in the whole's.
struct PartOfCell {
  template <class Celled>
  bool operator()(const Celled& part, const Celled& whole) const {
    return part.frame.affine() == whole.frame.affine() &&
           (part.cell.lower.array() >= whole.cell.lower.array()).all() &&
           (part.cell.upper.array() <= whole.cell.upper.array()).all();
  }
  bool operator()(const Polyhedron& part, const Polyhedron& whole) const {
    return part.vertices == whole.vertices && part.sides == whole.sides;
  }
  bool operator()(const Point&, const Point&) const { return false; }
  template <class Part, class Whole>
  bool operator()(const Part&, const Whole&) const {
    return false;
  }
};

bool lies_in_one(const Region& part, const std::vector<Region>& regions, const Rational& rounding) {
  const auto is_in = [&](const auto& holds) {
    return std::any_of(regions.begin(), regions.end(), [&](const Region& region) {
      return region.link == part.link && holds(region.shape);
    });
  };
  // Most are parts of cells, and comparing bounds costs next to nothing.
  if (is_in([&](const Shape& whole) { return std::visit(PartOfCell{}, part.shape, whole); })) {
    return true;
  }
  const std::vector<Vector> corners = std::visit(Corners{}, part.shape);
  return !corners.empty() && is_in([&](const Shape& region) {
    return std::all_of(corners.begin(), corners.end(), [&](const Vector& x) {
      return std::visit(Holds{x, rounding}, region);
    });
  });
}

}  // namespace

Geometry check_geometry(const StatedProblem& p, const Rational& rounding) {
  Geometry geometry;
  for (const Region& shape : p.shapes) {
    const std::string why = disagreement(p.masses, geometry.declared, shape, rounding);
    ++geometry.declared;
    if (why.empty()) ++geometry.agree;
    if (geometry.first_disagreement.empty()) geometry.first_disagreement = why;
    if (lies_in_one(shape, p.regions, rounding)) ++geometry.inside;
  }
  return geometry;
}

}  // namespace shapeid::certificate
