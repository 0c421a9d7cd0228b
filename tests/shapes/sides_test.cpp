// Lengths of a sector's sides against arcs worked out by hand: with no stretch they are the radius
// (at the outer end) times the angle.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "shapeid/models/cells.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

/// A radius of 0.3 m, somewhere and turned.
Eigen::Affine3d turned_and_enlarged() {
  return Eigen::Translation3d(0.2, -0.5, 0.7) *
         Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()) *
         Eigen::UniformScaling<double>(0.3);
}

TEST(Sides, OfASectorOfABallAreItsArcs) {
  // The polar angle passes the equator, where the azimuth's arc is longest.
  const Ellipsoid sector{turned_and_enlarged(), {{0.5, 0.9, -0.4}, {0.8, 2.1, 0.6}}};
  const double outer = 0.3 * 0.8;
  const Eigen::Vector3d arcs(0.3 * 0.3, outer * 1.2, outer * 1.0);
  EXPECT_LT(test::scaled_difference(side_lengths(sector), arcs, 3), test::few_hundred_eps);

  // It does not, and the widest circle of latitude is at the end nearer to it.
  const Ellipsoid northern{turned_and_enlarged(), {{0.5, 0.3, -0.4}, {0.8, 0.7, 0.6}}};
  const Eigen::Vector3d northern_arcs(0.3 * 0.3, outer * 0.4, outer * std::sin(0.7));
  EXPECT_LT(test::scaled_difference(side_lengths(northern), northern_arcs, 3),
            test::few_hundred_eps);
}

TEST(Sides, OfASectorOfACylinderAreItsArcs) {
  const Cylinder sector{turned_and_enlarged(), {{0.5, -0.4, -0.2}, {0.8, 0.6, 0.5}}};
  const Eigen::Vector3d arcs(0.3 * 0.3, 0.3 * 0.8 * 1.0, 0.3 * 0.7);
  EXPECT_LT(test::scaled_difference(side_lengths(sector), arcs, 3), test::few_hundred_eps);
}

}  // namespace
}  // namespace shapeid
