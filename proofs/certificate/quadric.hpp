// A quadratic polynomial of three coordinates, and the lowest it gets on solids.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/models/shape.hpp"
#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// x^T A x + b^T x + c in n coordinates.
struct Quadric {
  std::vector<Vector> A;
  Vector b;
  Rational c;

  [[nodiscard]] std::size_t size() const { return b.size(); }
  [[nodiscard]] Rational at(const Vector& x) const;
};

/// What a unit point mass at x costs if the ten parameters of its link cost `g` each: g^T pi(x),
/// with pi(x) = (1, x, y, z, y^2 + z^2, -x y, -x z, x^2 + z^2, -y z, x^2 + y^2).
[[nodiscard]] Quadric cost_of_point(const Vector& g);

/// A value that the polynomial does not go below, and a point where it gets there or near.
struct Lowest {
  Rational value;
  Vector point;
};

/// A value of at most zero that the polynomial goes below nowhere in space: zero, or its minimum if
/// A is positive definite. Empty if neither holds.
[[nodiscard]] std::optional<Rational> lowest_in_space(const Quadric& q);

/// Exactly, by the stationary points of all faces of the box.
[[nodiscard]] Lowest lowest_in_box(const Quadric& q, const Vector& lower, const Vector& upper);

/// Below the polynomial on the ball of this radius about the origin, by the S-lemma: with the best
/// multiplier (found in doubles, evaluated exactly) it is the minimum.
[[nodiscard]] Lowest lowest_in_ball(const Quadric& q, const Rational& radius);

/// Of a shape, in link coordinates: exact for cuboids, convex polyhedra and points; below it for
/// the others, which are put inside something: a cylinder (or its sector) inside a prism, an
/// ellipsoid (or its sector) inside its ball, a mesh that is not convex inside space.
[[nodiscard]] Lowest lowest_in(const Quadric& q, const Shape& shape);

}  // namespace shapeid::certificate
