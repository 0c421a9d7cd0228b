// Where the mass of a load is sought next.
#include "shapeid/diagnosis/load_places.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

const Box room{{-1.2, -1.0, -1.1}, {1.3, 1.05, 1.6}};

/// By the ten parameters: what a unit of mass at p adds is sum_i bend_i (p_i - least_i)^2.
Eigen::VectorXd bowl(const Eigen::Vector3d& bend, const Eigen::Vector3d& least) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(10);
  gradient[0] = bend.dot(least.cwiseAbs2());
  gradient.segment<3>(1) = -2.0 * bend.cwiseProduct(least);
  const Eigen::Vector3d tensor = 0.5 * (Eigen::Vector3d::Constant(bend.sum()) - 2.0 * bend);
  gradient[4] = tensor[0];
  gradient[7] = tensor[1];
  gradient[9] = tensor[2];
  return gradient;
}

TEST(LoadPlaces, TheSteepestIsWhereTheSlopeIsLeast) {
  const Eigen::Vector3d least(0.31, -0.17, 0.83);
  const SteepestPlace inside = steepest_place(bowl({2.0, 0.3, 1.0}, least), room);
  EXPECT_LT((inside.place - least).norm(), 1e-12);
  EXPECT_NEAR(inside.slope, 0.0, 1e-12);
  const SteepestPlace beyond = steepest_place(bowl({2.0, 0.3, 1.0}, {0.31, -5.0, 0.83}), room);
  EXPECT_LT((beyond.place - Eigen::Vector3d(0.31, -1.0, 0.83)).norm(), 1e-12);
  // A saddle: as far out along y as can be, to the side that is further from its middle.
  const SteepestPlace saddle = steepest_place(bowl({2.0, -0.3, 1.0}, {0.31, 0.2, 0.83}), room);
  EXPECT_LT((saddle.place - Eigen::Vector3d(0.31, -1.0, 0.83)).norm(), 1e-12);
}

RC_GTEST_PROP(LoadPlaces, NoneOfTheFirstIsSteeper, ()) {
  Eigen::VectorXd gradient(10);
  for (double& g : gradient) g = 1e-3 * *rc::gen::inRange(-5000, 5000);
  const SteepestPlace steepest = steepest_place(gradient, room);
  RC_ASSERT((steepest.place.array() >= room.lower.array()).all());
  RC_ASSERT((steepest.place.array() <= room.upper.array()).all());
  const auto slope = [&](const Eigen::Vector3d& p) {
    return gradient.dot(unit_parameters(make_point(p, 1.0)).values);
  };
  RC_ASSERT(steepest.slope == slope(steepest.place));
  // Terms of a few units, ten of them.
  constexpr double rounding = 1e-12;
  for (const Eigen::Vector3d& p : first_places(room)) {
    RC_ASSERT(steepest.slope <= slope(p) + rounding);
  }
}

TEST(LoadPlaces, TheRoomIsAMetreBeyondTheLinkAndItsChildren) {
  Robot robot = test::arm();
  const Eigen::Vector3d child = robot.links[2].joint.placement.translation();
  ASSERT_EQ(robot.links[2].parent, 1);
  // Of a crane's boom the centre is far from its joint, and what hangs on it further.
  const Eigen::Vector3d centre(-0.7, 2.3, 0.4);
  robot.links[1].inertia.values.segment<3>(1) = robot.links[1].inertia.mass() * centre;
  const Box own = room_for_load(robot, 1);
  const Eigen::Vector3d beyond = Eigen::Vector3d::Constant(furthest_load);
  EXPECT_TRUE(own.lower.isApprox(child.cwiseMin(centre).cwiseMin(0.0) - beyond));
  EXPECT_TRUE(own.upper.isApprox(child.cwiseMax(centre).cwiseMax(0.0) + beyond));
  for (const Eigen::Vector3d& p : first_places(own)) {
    EXPECT_TRUE((p.array() >= own.lower.array()).all() && (p.array() <= own.upper.array()).all());
  }
  // Of a link that is given without mass no centre is known.
  robot.links[1].inertia.values.setZero();
  const Box massless = room_for_load(robot, 1);
  EXPECT_TRUE(massless.lower.isApprox(child.cwiseMin(0.0) - beyond));
  EXPECT_TRUE(massless.upper.isApprox(child.cwiseMax(0.0) + beyond));
}

/// From any side they are the same: what is first where axes point one way is so where they point
/// the other.
TEST(LoadPlaces, AreAsManyOnEitherSide) {
  const Box turned{-room.upper, -room.lower};
  const std::vector<Eigen::Vector3d> places = first_places(room), others = first_places(turned);
  ASSERT_EQ(places.size(), others.size());
  for (const Eigen::Vector3d& p : places) {
    const auto here = [&](const Eigen::Vector3d& q) { return (p + q).norm() < 1e-12; };
    EXPECT_TRUE(std::any_of(others.begin(), others.end(), here)) << p.transpose();
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
