// Closed forms from textbooks, for whole bodies and for parts that have a name of their own.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using std::numbers::pi;
using test::few_hundred_eps;
using test::scaled_difference;

/// Rotated about no axis of symmetry and away from the origin.
Eigen::Isometry3d askew() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  T.translation() << 0.3, -0.1, 0.2;
  return T;
}

/// Holds `shape` against a volume and, for unit mass, a centre and principal moments about it in
/// the axes of `pose`.
void expect_body(const Shape& shape, const Eigen::Isometry3d& pose, double expected_volume,
                 const Eigen::Vector3d& centre, const Eigen::Vector3d& moments_about_centre) {
  const auto expected =
      moved(from_centre(1.0, centre, Eigen::Matrix3d(moments_about_centre.asDiagonal())), pose);
  EXPECT_LT(test::scaled(std::abs(volume(shape) - expected_volume), expected_volume, 1),
            few_hundred_eps);
  EXPECT_LT(scaled_difference(unit_parameters(shape).values, expected.values, 10), few_hundred_eps)
      << kind_name(shape) << "\n"
      << unit_parameters(shape).values.transpose() << "\n"
      << expected.values.transpose();
}

TEST(Textbook, Box) {
  const double a = 0.2, b = 0.5, c = 0.9;
  const Eigen::Vector3d I = Eigen::Vector3d(b * b + c * c, a * a + c * c, a * a + b * b) / 12.0;
  expect_body(make_cuboid({a, b, c}, askew()), askew(), a * b * c, {0, 0, 0}, I);
}

TEST(Textbook, SolidCylinder) {
  const double r = 0.3, h = 0.8;
  const double across = (3 * r * r + h * h) / 12.0;
  expect_body(make_cylinder(r, h, askew()), askew(), pi * r * r * h, {0, 0, 0},
              {across, across, r * r / 2.0});
}

TEST(Textbook, Tube) {
  const double inner = 0.1, outer = 0.3, h = 0.8;
  // Cut at r = 1/3 of the radius: the inner ninth of the volume.
  const Shape tube = divide(make_cylinder(outer, h, askew()), 0, 1.0 / 9.0).second;
  const double squares = inner * inner + outer * outer;
  const double across = (3 * squares + h * h) / 12.0;
  expect_body(tube, askew(), pi * (outer * outer - inner * inner) * h, {0, 0, 0},
              {across, across, squares / 2.0});
}

TEST(Textbook, HalfCylinder) {
  const double r = 0.3, h = 0.8;
  const Shape half = divide(make_cylinder(r, h, askew()), 1, 0.5).first;  // angles 0 to pi
  const double y = 4 * r / (3 * pi);
  expect_body(half, askew(), pi * r * r * h / 2.0, {0, y, 0},
              {r * r / 4 - y * y + h * h / 12, r * r / 4 + h * h / 12, r * r / 2 - y * y});
}

TEST(Textbook, Ball) {
  const double r = 0.4;
  expect_body(make_ellipsoid({r, r, r}, askew()), askew(), 4 * pi * r * r * r / 3, {0, 0, 0},
              Eigen::Vector3d::Constant(2 * r * r / 5));
}

TEST(Textbook, Ellipsoid) {
  const double a = 0.2, b = 0.5, c = 0.9;
  expect_body(make_ellipsoid({a, b, c}, askew()), askew(), 4 * pi * a * b * c / 3, {0, 0, 0},
              Eigen::Vector3d(b * b + c * c, a * a + c * c, a * a + b * b) / 5.0);
}

TEST(Textbook, Hemisphere) {
  const double r = 0.4;
  const Shape upper = divide(make_ellipsoid({r, r, r}, askew()), 1, 0.5).first;
  const double across = 83.0 * r * r / 320.0;
  expect_body(upper, askew(), 2 * pi * r * r * r / 3, {0, 0, 3 * r / 8},
              {across, across, 2 * r * r / 5});
}

TEST(Textbook, HollowBall) {
  const double inner = 0.2, outer = 0.4;
  const Shape shell = divide(make_ellipsoid(Eigen::Vector3d::Constant(outer), askew()), 0,
                             std::pow(inner / outer, 3))
                          .second;
  const double cubes = std::pow(outer, 3) - std::pow(inner, 3);
  const double moment = 0.4 * (std::pow(outer, 5) - std::pow(inner, 5)) / cubes;
  expect_body(shell, askew(), 4 * pi * cubes / 3, {0, 0, 0}, Eigen::Vector3d::Constant(moment));
}

// The corner tetrahedron with legs a, b, c. Products of inertia are not zero, so the covariance is
// compared: mean of (x - centroid)(x - centroid)^T is (3 on, -1 off the diagonal) / 80 of legs.
TEST(Textbook, CornerTetrahedron) {
  const Eigen::Vector3d legs(0.2, 0.5, 0.9);
  const Shape solid = make_mesh({{0, 0, 0}, {legs[0], 0, 0}, {0, legs[1], 0}, {0, 0, legs[2]}},
                                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, askew());
  const Eigen::Matrix3d unit = 4.0 * Eigen::Matrix3d::Identity() - Eigen::Matrix3d::Ones();
  const Eigen::Matrix3d R = askew().linear();
  const Eigen::Matrix3d expected =
      R * legs.asDiagonal() * unit * legs.asDiagonal() * R.transpose() / 80.0;
  const Moments m = moments(solid);
  EXPECT_LT(test::scaled(std::abs(m.volume - legs.prod() / 6.0), legs.prod(), 1), few_hundred_eps);
  EXPECT_LT(scaled_difference(m.centroid, askew() * (legs / 4.0), 3), few_hundred_eps);
  EXPECT_LT(scaled_difference(m.covariance, expected, 9), few_hundred_eps);
}

TEST(Textbook, Point) {
  const Eigen::Vector3d r(0.1, 0.2, -0.3);
  const Shape point = make_point(r, 1e-6);
  EXPECT_EQ(volume(point), 1e-6);
  EXPECT_EQ(unit_parameters(point).values, from_centre(1.0, r, Eigen::Matrix3d::Zero()).values);
}

}  // namespace
}  // namespace shapeid
