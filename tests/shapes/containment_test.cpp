// Parts as sets of points: they lie in the whole, do not overlap, leave nothing out.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid {
namespace {

/// How far a point may be from where it should be, m.
double rounding(const Shape& shape) {
  return test::few_hundred_eps * std::numeric_limits<double>::epsilon() * test::reach(shape);
}

RC_GTEST_PROP(Containment, PointsInsideAreInside, ()) {
  const Shape shape = *test::solid();
  RC_ASSERT(contains(shape, test::point_inside(shape, *test::whereabouts()), 0.0));
}

RC_GTEST_PROP(Containment, PointsOutsideTheBoundsAreOutside, ()) {
  const Shape shape = *test::solid();
  const auto [lower, upper] = bounds(shape);
  const int axis = *rc::gen::inRange(0, 3);
  Eigen::Vector3d p = test::point_inside(shape, *test::whereabouts());
  p[axis] = upper[axis] + 2.0 * rounding(shape);
  RC_ASSERT(!contains(shape, p, rounding(shape)));
  p[axis] = lower[axis] - 2.0 * rounding(shape);
  RC_ASSERT(!contains(shape, p, rounding(shape)));
}

RC_GTEST_PROP(Containment, PartsLieInTheWholeAndDoNotOverlap, ()) {
  const Shape whole = *test::solid();
  const test::Cut cut = *test::cut();
  const auto [lower, upper] = divide(whole, cut.axis, cut.fraction);
  const Eigen::Vector3d where = *test::whereabouts();
  const Eigen::Vector3d in_lower = test::point_inside(lower, where);
  const Eigen::Vector3d in_upper = test::point_inside(upper, where);
  RC_ASSERT(contains(whole, in_lower, rounding(whole)));
  RC_ASSERT(contains(whole, in_upper, rounding(whole)));
  RC_ASSERT(!contains(upper, in_lower));
  RC_ASSERT(!contains(lower, in_upper));
}

RC_GTEST_PROP(Containment, PartsFillTheWhole, ()) {
  const Shape whole = *test::solid();
  const test::Cut cut = *test::cut();
  const auto [lower, upper] = divide(whole, cut.axis, cut.fraction);
  const Eigen::Vector3d p = test::point_inside(whole, *test::whereabouts());
  RC_ASSERT(contains(lower, p, rounding(whole)) || contains(upper, p, rounding(whole)));
}

// A grid over the cell comes close to the bounds and never leaves them.
RC_GTEST_PROP(Containment, BoundsAreTight, ()) {
  const Shape shape =
      *rc::gen::oneOf(test::cuboid_cell(), test::cylinder_sector(), test::ellipsoid_sector());
  constexpr int steps = 32;
  // A turn in 32 steps misses an extreme by 1 - cos(turn / 64) = 0.005 of the radius at most, in
  // each of two angles.
  constexpr double missed = 0.01;
  Eigen::Vector3d least = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d most = -least;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      for (int k = 0; k <= steps; ++k) {
        const Eigen::Vector3d p = test::point_inside(shape, Eigen::Vector3d(i, j, k) / steps);
        least = least.cwiseMin(p);
        most = most.cwiseMax(p);
      }
    }
  }
  const auto [lower, upper] = bounds(shape);
  const Eigen::Vector3d allowed = missed * (upper - lower);
  RC_ASSERT(((least - lower).array() >= -rounding(shape)).all());
  RC_ASSERT(((upper - most).array() >= -rounding(shape)).all());
  RC_ASSERT((least - lower).cwiseMax(upper - most).cwiseQuotient(allowed).maxCoeff() <= 1.0);
}

TEST(Containment, SlackIsADistance) {
  const Shape ball = make_ellipsoid({0.2, 0.2, 0.2}, Eigen::Isometry3d::Identity());
  const Eigen::Vector3d outside = 0.21 * Eigen::Vector3d(1, 2, 2) / 3.0;
  EXPECT_FALSE(contains(ball, outside));
  EXPECT_FALSE(contains(ball, outside, 0.0099));
  EXPECT_TRUE(contains(ball, outside, 0.0101));
  // Of a box of triangles: from the middle of a face, an edge and a corner, one after the other.
  const Shape box = make_convex_hull(
      {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}, {3, 2, 0}, {3, 0, 1}, {0, 2, 1}, {3, 2, 1}},
      Eigen::Isometry3d::Identity());
  for (const Eigen::Vector3d& out :
       {Eigen::Vector3d(1, 0.5, 1.1), Eigen::Vector3d(2, 1.6, -0.1),
        Eigen::Vector3d(3.06, 1.1, 1.08), Eigen::Vector3d(-0.1, 0.9, 0.4)}) {
    EXPECT_FALSE(contains(box, out, 0.0999));
    EXPECT_TRUE(contains(box, out, 0.1001));
  }
  const Eigen::Vector3d off_the_corner(3.02, 2.03, 1.06);
  EXPECT_FALSE(contains(box, off_the_corner, 0.0699));
  EXPECT_TRUE(contains(box, off_the_corner, 0.0701));
  const Shape point = make_point({0.1, 0.0, 0.0}, 1e-6);
  EXPECT_TRUE(contains(point, {0.1, 0.0, 0.0}));
  EXPECT_FALSE(contains(point, {0.11, 0.0, 0.0}, 0.0099));
}

}  // namespace
}  // namespace shapeid
