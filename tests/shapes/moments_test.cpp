// Moments of every kind against quadrature, and under maps of the frame.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/shapes/quadrature.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid {
namespace {

using test::check_against_quadrature;
using test::few_hundred_eps;
using test::scaled;
using test::scaled_difference;

RC_GTEST_PROP(Moments, CuboidCellsAgreeWithQuadrature, ()) {
  check_against_quadrature(*test::cuboid_cell());
}
RC_GTEST_PROP(Moments, CylinderSectorsAgreeWithQuadrature, ()) {
  check_against_quadrature(*test::cylinder_sector());
}
RC_GTEST_PROP(Moments, EllipsoidSectorsAgreeWithQuadrature, ()) {
  check_against_quadrature(*test::ellipsoid_sector());
}
RC_GTEST_PROP(Moments, PolyhedraAgreeWithQuadrature, ()) {
  check_against_quadrature(*test::convex_polyhedron());
}

// All widths alike and small, so that nothing but the part's own size can hide an error; at the
// poles and the axis, where polar angle and azimuth degenerate, as well as anywhere else.
RC_GTEST_PROP(Moments, SliversAgreeWithQuadrature, ()) {
  const double width = *test::magnitude(1e-4, 1e-2);
  const auto start = [&](double range) {
    return *rc::gen::oneOf(rc::gen::just(0.0), test::real(0.0, range - width),
                           rc::gen::just(range - width));
  };
  const Eigen::Vector3d w = Eigen::Vector3d::Constant(width);
  Eigen::Affine3d frame(*test::pose(0.5));
  const Eigen::Vector3d sector(start(1.0), start(6.0), start(1.0));
  check_against_quadrature(Cylinder{frame, {sector, sector + w}});

  // At a pole the whole turn of azimuths is as narrow as the cell's polar angle.
  const bool turn = *rc::gen::arbitrary<bool>();
  const Eigen::Vector3d lower(start(1.0), start(std::numbers::pi), 0.0);
  const Eigen::Vector3d upper = lower + w;
  check_against_quadrature(
      Ellipsoid{frame, {lower, {upper[0], upper[1], turn ? 2.0 * std::numbers::pi : upper[2]}}});
}

// All of the polar angles but a little at one pole.
RC_GTEST_PROP(Moments, NearlyWholeBallsAgreeWithQuadrature, ()) {
  Ellipsoid ball = std::get<Ellipsoid>(make_ellipsoid({0.2, 0.3, 0.4}, *test::pose(0.5)));
  const double missing = *test::magnitude(1e-8, 1e-1);
  if (*rc::gen::arbitrary<bool>()) {
    ball.cell.lower[1] += missing;
  } else {
    ball.cell.upper[1] -= missing;
  }
  check_against_quadrature(ball);
}

// Equations (10)-(13) put the moments together about the link origin: undo it by the parallel axis
// theorem.
RC_GTEST_PROP(Moments, UnitParametersHoldThem, ()) {
  const Shape shape = *test::solid();
  const Moments m = moments(shape);
  const PseudoInertia sigma = pseudo_inertia(unit_parameters(shape));
  const Eigen::Matrix3d second = m.covariance + m.centroid * m.centroid.transpose();
  RC_ASSERT(sigma(3, 3) == 1.0);
  RC_ASSERT(Eigen::Vector3d(sigma.topRightCorner(3, 1)) == m.centroid);
  RC_ASSERT(scaled_difference(sigma.topLeftCorner(3, 3), second, 9) < few_hundred_eps);
}

// Sigma -> T Sigma T^T, and for rigid maps the same through moved().
RC_GTEST_PROP(Moments, RigidMapsMoveThem, ()) {
  const Shape shape = *test::solid();
  const Eigen::Isometry3d T = *test::pose(0.7);
  const auto moved_shape = unit_parameters(test::mapped(shape, T));
  const auto moved_body = moved(unit_parameters(shape), T);
  RC_ASSERT(scaled_difference(moved_shape.values, moved_body.values, 10) < few_hundred_eps);
}

RC_GTEST_PROP(Moments, AffineMapsStretchThem, ()) {
  const Shape shape = *test::solid();
  Eigen::Affine3d T(*test::pose(0.7));
  T.linear() += 0.3 * *test::rotation();
  const PseudoInertia stretched = pseudo_inertia(unit_parameters(test::mapped(shape, T)));
  const PseudoInertia by_hand =
      T.matrix() * pseudo_inertia(unit_parameters(shape)) * T.matrix().transpose();
  RC_ASSERT(scaled_difference(stretched, by_hand, 16) < few_hundred_eps);
  const double expected = volume(shape) * std::abs(T.linear().determinant());
  // The determinant itself cancels when the two rotations nearly do.
  RC_ASSERT(scaled(std::abs(volume(test::mapped(shape, T)) - expected),
                   volume(shape) * std::pow(T.linear().norm(), 3), 9) < few_hundred_eps);
}

RC_GTEST_PROP(Moments, ExistAsBodies, ()) {
  RC_ASSERT(!why_impossible(unit_parameters(*test::solid())));
}

}  // namespace
}  // namespace shapeid
