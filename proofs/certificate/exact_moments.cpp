#include "shapeid/proofs/certificate/exact_moments.hpp"

#include <variant>

namespace shapeid::certificate {
namespace {

/// Integrals of (x, 1)(x, 1)^T, of which the upper triangle counts.
using Second = std::array<std::array<Enclosure, 4>, 4>;

/// integral of x^n over [a, b]
Rational power_integral(const Rational& a, const Rational& b, int n) {
  Rational low = a, high = b;
  for (int k = 0; k < n; ++k) {
    low *= a;
    high *= b;
  }
  return (high - low) / (n + 1);
}

/// Integrals of 1, cos, sin, cos^2, sin cos, sin^2 over [a, b].
struct Turn {
  Enclosure one, c, s, cc, sc, ss;
};

std::optional<Turn> turn(const Rational& a, const Rational& b) {
  const auto at_a = sine_and_cosine(a), at_b = sine_and_cosine(b);
  if (!at_a || !at_b) return std::nullopt;
  const auto& [sa, ca] = *at_a;
  const auto& [sb, cb] = *at_b;
  const Enclosure half = Rational((b - a) / 2), twist = (sb * cb - sa * ca) / 2;
  return Turn{Rational(b - a),         sb - sa,     ca - cb, half + twist,
              (sb * sb - sa * sa) / 2, half - twist};
}

struct Integrals {
  std::optional<Second> operator()(const Cuboid& s) const {
    std::array<std::array<Rational, 3>, 3> of;  // of[axis][power]
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      for (int n = 0; n < 3; ++n) {
        of[i][static_cast<std::size_t>(n)] =
            power_integral(exact(s.cell.lower[axis]), exact(s.cell.upper[axis]), n);
      }
    }
    Second M;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        Rational product = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          product *= of[axis][(i == axis ? 1U : 0U) + (j == axis ? 1U : 0U)];
        }
        M[i][j] = product;
      }
    }
    return M;
  }

  /// dx dy dz = r dr dt dz
  std::optional<Second> operator()(const Cylinder& s) const {
    const auto t = turn(exact(s.cell.lower.y()), exact(s.cell.upper.y()));
    if (!t) return std::nullopt;
    const auto r = [&](int n) -> Enclosure {
      return power_integral(exact(s.cell.lower.x()), exact(s.cell.upper.x()), n + 1);
    };
    const auto z = [&](int n) -> Enclosure {
      return power_integral(exact(s.cell.lower.z()), exact(s.cell.upper.z()), n);
    };
    Second M;
    M[0][0] = r(2) * t->cc * z(0);
    M[0][1] = r(2) * t->sc * z(0);
    M[1][1] = r(2) * t->ss * z(0);
    M[0][2] = r(1) * t->c * z(1);
    M[1][2] = r(1) * t->s * z(1);
    M[2][2] = r(0) * t->one * z(2);
    M[0][3] = r(1) * t->c * z(0);
    M[1][3] = r(1) * t->s * z(0);
    M[2][3] = r(0) * t->one * z(1);
    M[3][3] = r(0) * t->one * z(0);
    return M;
  }

  /// dx dy dz = r^2 sin(p) dr dp dt, with p from +z
  std::optional<Second> operator()(const Ellipsoid& s) const {
    const Rational a = exact(s.cell.lower.y()), b = exact(s.cell.upper.y());
    const auto t = turn(exact(s.cell.lower.z()), exact(s.cell.upper.z()));
    const auto at_a = sine_and_cosine(a), at_b = sine_and_cosine(b);
    const auto p = turn(a, b);
    if (!t || !at_a || !at_b || !p) return std::nullopt;
    const auto cube = [](const Enclosure& x) { return x * x * x; };
    const auto& [sa, ca] = *at_a;
    const auto& [sb, cb] = *at_b;
    const Enclosure s1 = ca - cb, s2 = p->ss, s1c = p->sc;
    const Enclosure s1cc = (cube(ca) - cube(cb)) / 3, s2c = (cube(sb) - cube(sa)) / 3;
    const Enclosure s3 = s1 - s1cc;
    const auto r = [&](int n) -> Enclosure {
      return power_integral(exact(s.cell.lower.x()), exact(s.cell.upper.x()), n + 2);
    };
    Second M;
    M[0][0] = r(2) * s3 * t->cc;
    M[0][1] = r(2) * s3 * t->sc;
    M[1][1] = r(2) * s3 * t->ss;
    M[0][2] = r(2) * s2c * t->c;
    M[1][2] = r(2) * s2c * t->s;
    M[2][2] = r(2) * s1cc * t->one;
    M[0][3] = r(1) * s2 * t->c;
    M[1][3] = r(1) * s2 * t->s;
    M[2][3] = r(1) * s1c * t->one;
    M[3][3] = r(0) * s1 * t->one;
    return M;
  }

  /// Signed tetrahedra from the origin: with corners 0, a, b, c and s = a + b + c, times the
  /// determinant, 1/6, s/24 and (s s^T + a a^T + b b^T + c c^T)/120.
  std::optional<Second> operator()(const Polyhedron& s) const {
    std::array<std::array<Rational, 4>, 4> M;
    for (const auto& face : triangles(s)) {
      std::array<Vector, 3> x;
      for (std::size_t i = 0; i < 3; ++i) {
        x[i] = exact(Eigen::VectorXd(s.vertices[static_cast<std::size_t>(face[i])]));
      }
      const auto& [a, b, c] = x;
      const Rational six = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0]);
      M[3][3] += six / 6;
      for (std::size_t i = 0; i < 3; ++i) {
        const Rational si = a[i] + b[i] + c[i];
        M[i][3] += six * si / 24;
        for (std::size_t j = i; j < 3; ++j) {
          const Rational sj = a[j] + b[j] + c[j];
          M[i][j] += six * (si * sj + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]) / 120;
        }
      }
    }
    Second enclosed;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i; j < 4; ++j) enclosed[i][j] = M[i][j];
    }
    return enclosed;
  }

  std::optional<Second> operator()(const Point& s) const {
    const Vector x = exact(Eigen::VectorXd(s.position));
    const Rational v = exact(s.nominal_volume);
    Second M;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) M[i][j] = Rational(v * x[i] * x[j]);
      M[i][3] = Rational(v * x[i]);
    }
    M[3][3] = v;
    return M;
  }
};

/// T M T^T det T, for T = [L t; 0 1].
Second moved(const Second& M, const Eigen::Affine3d& frame) {
  const auto entry = [&](std::size_t i, std::size_t j) -> Rational {
    if (i == 3) return j == 3 ? 1 : 0;
    return exact(frame(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  };
  const auto minor = [&](std::size_t i, std::size_t j) -> Rational {
    return entry(1, i) * entry(2, j) - entry(1, j) * entry(2, i);
  };
  const Rational determinant =
      entry(0, 0) * minor(1, 2) - entry(0, 1) * minor(0, 2) + entry(0, 2) * minor(0, 1);
  Second N;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) {
        for (std::size_t l = 0; l < 4; ++l) {
          const Rational factor = entry(i, k) * entry(j, l) * determinant;
          N[i][j] = N[i][j] + Enclosure(factor) * (k <= l ? M[k][l] : M[l][k]);
        }
      }
    }
  }
  return N;
}

struct InLink {
  template <class Celled>
  Second operator()(const Celled& s, const Second& M) const {
    return moved(M, s.frame);
  }
  Second operator()(const Polyhedron&, const Second& M) const { return M; }
  Second operator()(const Point&, const Second& M) const { return M; }
};

}  // namespace

std::optional<ExactMoments> exact_moments(const Shape& shape) {
  const auto integrals = std::visit(Integrals{}, shape);
  if (!integrals) return std::nullopt;
  const Second M =
      std::visit([&](const auto& s) -> Second { return InLink{}(s, *integrals); }, shape);
  const Enclosure& v = M[3][3];
  if (sgn(v.lower) <= 0) return std::nullopt;
  return ExactMoments{
      v,
      {1, M[0][3] / v, M[1][3] / v, M[2][3] / v, (M[1][1] + M[2][2]) / v, -M[0][1] / v,
       -M[0][2] / v, (M[0][0] + M[2][2]) / v, -M[1][2] / v, (M[0][0] + M[1][1]) / v}};
}

}  // namespace shapeid::certificate
