#include "shapeid/tests/shapes/quadrature.hpp"

#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid::test {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

struct Node {
  Real x, weight;
};

/// Gauss-Legendre nodes on [lower, upper]: roots of the Legendre polynomial by Newton's method.
std::vector<Node> nodes(int count, Real lower, Real upper) {
  std::vector<Node> result;
  for (int i = 0; i < count; ++i) {
    Real x = std::cos(std::numbers::pi_v<Real> * (static_cast<Real>(i) + 0.75L) /
                      (static_cast<Real>(count) + 0.5L));
    Real slope = 0.0L;
    for (int iteration = 0; iteration < 10; ++iteration) {
      Real p = 1.0L;
      Real before = 0.0L;
      for (int k = 0; k < count; ++k) {
        const Real n = static_cast<Real>(k);
        const Real next = ((2.0L * n + 1.0L) * x * p - n * before) / (n + 1.0L);
        before = p;
        p = next;
      }
      slope = static_cast<Real>(count) * (x * p - before) / (x * x - 1.0L);
      x -= p / slope;
    }
    const Real half = 0.5L * (upper - lower);
    result.push_back(
        {0.5L * (lower + upper) + half * x, half * 2.0L / ((1.0L - x * x) * slope * slope)});
  }
  return result;
}

/// Sums of weight, weight x, weight x x^T.
struct Sums {
  Real zeroth = 0.0L;
  Vector first = Vector::Zero();
  Matrix second = Matrix::Zero();

  void add(Real weight, const Vector& x) {
    zeroth += weight;
    first += weight * x;
    second += weight * x * x.transpose();
  }
};

/// From sums of positions as seen from `origin`.
Moments rounded(const Sums& sums, const Vector& origin) {
  const Vector mean = sums.first / sums.zeroth;
  const Matrix covariance = sums.second / sums.zeroth - mean * mean.transpose();
  return {static_cast<double>(sums.zeroth), (origin + mean).cast<double>(),
          covariance.cast<double>()};
}

/// Coordinates to canonical point, and the volume element there.
struct Chart {
  Vector point;
  Real element;
};
Chart chart(const Cuboid&, const Vector& c) { return {c, 1.0L}; }
Chart chart(const Cylinder&, const Vector& c) {
  return {{c[0] * std::cos(c[1]), c[0] * std::sin(c[1]), c[2]}, c[0]};
}
Chart chart(const Ellipsoid&, const Vector& c) {
  const Real s = std::sin(c[1]);
  return {{c[0] * s * std::cos(c[2]), c[0] * s * std::sin(c[2]), c[0] * std::cos(c[1])},
          c[0] * c[0] * s};
}

template <typename Kind>
Moments over_cell(const Kind& shape) {
  // Polynomials of degree four and sines over at most a turn: 28 nodes leave less than 1e-20.
  constexpr int count = 28;
  const Vector lower = shape.cell.lower.template cast<Real>();
  const Vector upper = shape.cell.upper.template cast<Real>();
  const Matrix L = shape.frame.linear().template cast<Real>();
  const Vector t = shape.frame.translation().template cast<Real>();
  const Vector origin = chart(shape, 0.5L * (lower + upper)).point;
  const Real stretch = std::abs(L.determinant());

  const std::vector<Node> xs = nodes(count, lower[0], upper[0]);
  const std::vector<Node> ys = nodes(count, lower[1], upper[1]);
  const std::vector<Node> zs = nodes(count, lower[2], upper[2]);
  Sums sums;
  for (const Node& x : xs) {
    for (const Node& y : ys) {
      for (const Node& z : zs) {
        const Chart here = chart(shape, Vector(x.x, y.x, z.x));
        sums.add(stretch * here.element * x.weight * y.weight * z.weight,
                 L * (here.point - origin));
      }
    }
  }
  return rounded(sums, t + L * origin);
}

Moments over_surface(const Polyhedron& solid) {
  const Vector origin = solid.vertices.front().cast<Real>();
  const std::vector<Node> line = nodes(4, 0.0L, 1.0L);  // exact to degree seven
  Sums sums;
  for (const auto& face : triangles(solid)) {
    const auto at = [&](int i) -> Vector {
      return solid.vertices[static_cast<std::size_t>(i)].cast<Real>() - origin;
    };
    const Vector a = at(face[0]);
    const Vector ab = at(face[1]) - a;
    const Vector ac = at(face[2]) - a;
    const Vector normal = ab.cross(ac);
    for (const Node& s : line) {
      for (const Node& t : line) {
        const Vector x = a + s.x * ((1.0L - t.x) * ab + t.x * ac);
        // div(x) = 3, div(x_i x) = 4 x_i, div(x_i x_j x) = 5 x_i x_j.
        const Real flux = s.x * s.weight * t.weight * x.dot(normal);
        sums.zeroth += flux / 3.0L;
        sums.first += flux / 4.0L * x;
        sums.second += flux / 5.0L * x * x.transpose();
      }
    }
  }
  return rounded(sums, origin);
}

}  // namespace

Moments integrated(const Shape& shape) {
  return std::visit(
      [](const auto& s) -> Moments {
        if constexpr (requires { s.cell; }) {
          return over_cell(s);
        } else if constexpr (requires { s.sides; }) {
          return over_surface(s);
        } else {
          throw std::invalid_argument("there is nothing to integrate over a point");
        }
      },
      shape);
}

void check_against_quadrature(const Shape& shape) {
  const Moments here = moments(shape);
  const Moments there = integrated(shape);
  const double rounding = volume_rounding(shape);
  RC_ASSERT(scaled(std::abs(here.volume - there.volume), there.volume * rounding, 1) <
            few_hundred_eps);
  RC_ASSERT(scaled((here.centroid - there.centroid).norm(), reach(shape) * rounding, 3) <
            few_hundred_eps);
  RC_ASSERT(scaled((here.covariance - there.covariance).norm(), there.covariance.trace() * rounding,
                   9) < few_hundred_eps);
}

}  // namespace shapeid::test
