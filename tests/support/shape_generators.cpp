#include "shapeid/tests/support/shape_generators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shapeid/tests/support/generators.hpp"

namespace shapeid {

void showValue(const Shape& shape, std::ostream& out) {
  out.precision(17);
  out << kind_name(shape);
  std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.cell; }) {
          out << "\ncell " << s.cell.lower.transpose() << " to " << s.cell.upper.transpose()
              << "\nframe\n"
              << s.frame.matrix();
        } else if constexpr (requires { s.sides; }) {
          for (const auto& v : s.vertices) out << "\nvertex " << v.transpose();
          for (const auto& f : triangles(s)) out << "\nface " << f[0] << ' ' << f[1] << ' ' << f[2];
        } else {
          out << " at " << s.position.transpose();
        }
      },
      shape);
}

}  // namespace shapeid

namespace shapeid::test {
namespace {

using std::numbers::pi;

struct Interval {
  double lower, upper;
};

/// Inside [lower, upper], often with one of its ends.
rc::Gen<Interval> interval(double lower, double upper) {
  const auto place = rc::gen::oneOf(rc::gen::just(0.0), real(0.0, 1.0), rc::gen::just(1.0));
  return rc::gen::map(rc::gen::pair(magnitude(1e-4, 1.0), place), [=](const auto& drawn) {
    const auto& [width, at] = drawn;
    const double start = lower + at * (1.0 - width) * (upper - lower);
    if (at == 1.0) return Interval{start, upper};
    return Interval{start, std::min(upper, start + width * (upper - lower))};
  });
}

/// Up to one turn, starting anywhere.
rc::Gen<Interval> turn() {
  return rc::gen::map(rc::gen::pair(magnitude(1e-4, 1.0), real(-2.0 * pi, 2.0 * pi)),
                      [](const auto& drawn) {
                        const auto& [width, start] = drawn;
                        if (width == 1.0) return Interval{0.0, 2.0 * pi};
                        return Interval{start, start + width * 2.0 * pi};
                      });
}

rc::Gen<Eigen::Affine3d> frame() {
  const auto size = magnitude(0.02, 2.0);
  return rc::gen::map(
      rc::gen::tuple(pose(0.5), rc::gen::tuple(size, size, size), rotation()),
      [](const auto& drawn) {
        const auto& [T, sizes, shear] = drawn;
        const Eigen::Vector3d stretch(std::get<0>(sizes), std::get<1>(sizes), std::get<2>(sizes));
        return Eigen::Affine3d(T * Eigen::Scaling(stretch) * Eigen::Affine3d(shear));
      });
}

template <typename Kind>
rc::Gen<Shape> sector(rc::Gen<Interval> a, rc::Gen<Interval> b, rc::Gen<Interval> c) {
  return rc::gen::map(
      rc::gen::tuple(frame(), std::move(a), std::move(b), std::move(c)),
      [](const auto& drawn) -> Shape {
        const auto& [map, x, y, z] = drawn;
        return Kind{map, {{x.lower, y.lower, z.lower}, {x.upper, y.upper, z.upper}}};
      });
}

Eigen::Vector3d cell_point(const Cell& cell, const Eigen::Vector3d& where) {
  return cell.lower + where.cwiseProduct(cell.upper - cell.lower);
}

Eigen::Vector3d inside(const Cuboid& cuboid, const Eigen::Vector3d& where) {
  return cuboid.frame * cell_point(cuboid.cell, where);
}
Eigen::Vector3d inside(const Cylinder& cylinder, const Eigen::Vector3d& where) {
  const Eigen::Vector3d c = cell_point(cylinder.cell, where);
  return cylinder.frame * Eigen::Vector3d(c[0] * std::cos(c[1]), c[0] * std::sin(c[1]), c[2]);
}
Eigen::Vector3d inside(const Ellipsoid& ellipsoid, const Eigen::Vector3d& where) {
  const Eigen::Vector3d c = cell_point(ellipsoid.cell, where);
  const double across = c[0] * std::sin(c[1]);
  return ellipsoid.frame *
         Eigen::Vector3d(across * std::cos(c[2]), across * std::sin(c[2]), c[0] * std::cos(c[1]));
}
Eigen::Vector3d inside(const Polyhedron& solid, const Eigen::Vector3d& where) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& v : solid.vertices) middle += v / static_cast<double>(solid.vertices.size());
  const auto faces = triangles(solid);
  const double face_count = static_cast<double>(faces.size());
  const auto& face = faces[static_cast<std::size_t>(where[0] * face_count)];
  const auto at = [&](int i) { return solid.vertices[static_cast<std::size_t>(i)]; };
  const double s = std::sqrt(where[1]);
  const Eigen::Vector3d on_face =
      (1.0 - s) * at(face[0]) + s * (1.0 - where[2]) * at(face[1]) + s * where[2] * at(face[2]);
  const double outward = where[0] * face_count - std::floor(where[0] * face_count);
  return middle + (0.01 + 0.98 * outward) * (on_face - middle);
}
Eigen::Vector3d inside(const Point& point, const Eigen::Vector3d&) { return point.position; }

}  // namespace

rc::Gen<Shape> cuboid_cell() {
  return sector<Cuboid>(interval(-0.5, 0.5), interval(-0.5, 0.5), interval(-0.5, 0.5));
}

rc::Gen<Shape> cylinder_sector() {
  return sector<Cylinder>(interval(0.0, 1.0), turn(), interval(-0.5, 0.5));
}

rc::Gen<Shape> ellipsoid_sector() {
  return sector<Ellipsoid>(interval(0.0, 1.0), interval(0.0, pi), turn());
}

rc::Gen<Shape> convex_polyhedron() {
  const auto points = rc::gen::mapcat(rc::gen::inRange(0, 17), [](int more) {
    return rc::gen::container<std::vector<Eigen::Vector3d>>(static_cast<std::size_t>(more),
                                                            vector3(0.5));
  });
  return rc::gen::map(rc::gen::pair(frame(), points), [](auto drawn) {
    auto& [map, cloud] = drawn;
    // A tetrahedron in any case, so that shrinking cannot make it flat.
    for (const Eigen::Vector3d& v :
         {Eigen::Vector3d(0.3, 0.2, 0.25), Eigen::Vector3d(-0.4, -0.3, 0.2),
          Eigen::Vector3d(-0.2, 0.3, -0.3), Eigen::Vector3d(0.2, -0.3, -0.2)}) {
      cloud.push_back(v);
    }
    for (Eigen::Vector3d& v : cloud) v = map * v;
    return make_convex_hull(cloud, Eigen::Isometry3d::Identity());
  });
}

rc::Gen<Shape> solid() {
  return rc::gen::oneOf(cuboid_cell(), cylinder_sector(), ellipsoid_sector(), convex_polyhedron());
}

rc::Gen<Cut> cut() {
  return rc::gen::map(
      rc::gen::tuple(rc::gen::inRange(0, 3), real(0.2, 0.8), rc::gen::arbitrary<bool>()),
      [](const auto& drawn) {
        return Cut{std::get<0>(drawn), std::get<1>(drawn), std::get<2>(drawn)};
      });
}

void showValue(const Cut& cut, std::ostream& out) {
  out << (cut.upper ? "upper" : "lower") << " part of a cut across " << cut.axis << " at "
      << cut.fraction;
}

rc::Gen<Eigen::Vector3d> whereabouts() {
  return rc::gen::map(vector3(0.499), [](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v + Eigen::Vector3d::Constant(0.5);
  });
}

Eigen::Vector3d point_inside(const Shape& shape, const Eigen::Vector3d& where) {
  return std::visit([&](const auto& s) { return inside(s, where); }, shape);
}

Shape mapped(const Shape& shape, const Eigen::Affine3d& map) {
  Shape result = shape;
  std::visit(
      [&](auto& s) {
        if constexpr (requires { s.frame; }) {
          s.frame = map * s.frame;
        } else if constexpr (requires { s.vertices; }) {
          for (auto& v : s.vertices) v = map * v;
        } else {
          s.position = map * s.position;
        }
      },
      result);
  return result;
}

double reach(const Shape& shape) {
  const auto [lower, upper] = bounds(shape);
  return lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm();
}

double own_size(const Shape& shape) { return std::sqrt(moments(shape).covariance.trace()); }

double volume_rounding(const Shape& shape) {
  if (!std::holds_alternative<Polyhedron>(shape)) return 1.0;
  return 1.0 + reach(shape) * std::pow(own_size(shape), 2) / volume(shape);
}

}  // namespace shapeid::test
