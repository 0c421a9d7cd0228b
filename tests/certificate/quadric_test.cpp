// The lowest value of a quadratic polynomial on solids, against points inside them.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid::certificate {
namespace {

Vector exact3(const Eigen::Vector3d& x) { return exact(Eigen::VectorXd(x)); }

/// pi(x), written down once more.
Vector point_parameters(const Eigen::Vector3d& p) {
  const Vector x = exact3(p);
  return {1,
          x[0],
          x[1],
          x[2],
          x[1] * x[1] + x[2] * x[2],
          -x[0] * x[1],
          -x[0] * x[2],
          x[0] * x[0] + x[2] * x[2],
          -x[1] * x[2],
          x[0] * x[0] + x[1] * x[1]};
}

RC_GTEST_PROP(Quadric, IsTheCostOfAPointMass, ()) {
  const Vector g = exact(*test::vector(10, 1.0));
  const Eigen::Vector3d x = *test::vector3(2.0);
  RC_ASSERT(cost_of_point(g).at(exact3(x)) == dot(g, point_parameters(x)));
}

RC_GTEST_PROP(Quadric, NoPointOfTheShapeIsLower, ()) {
  const Vector g = exact(*test::vector(10, 1.0));
  const Shape shape = *test::solid();
  const Quadric q = cost_of_point(g);
  const Lowest lowest = lowest_in(q, shape);
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d x = test::point_inside(shape, *test::whereabouts());
    // A drawn point is inside to rounding of its coordinates; 1e-9 of the slopes is far more.
    const double slack = 1e-9 * (1.0 + std::pow(test::reach(shape), 2));
    RC_ASSERT(lowest.value <= q.at(exact3(x)) + exact(slack * 20.0));
  }
}

/// An L-shaped prism that its file calls convex: the polynomial is lowest in the corner that is not
/// behind every face.
TEST(Quadric, WhatAFileCallsConvexNeedNotBe) {
  const std::vector<std::array<double, 2>> outline = {{0, 0}, {3, 0}, {3, 1},
                                                      {1, 1}, {1, 3}, {0, 3}};
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : outline) corners.emplace_back(x, y, z);
  }
  std::vector<std::array<int, 3>> faces;
  const std::vector<std::array<int, 3>> cap = {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  for (const auto& [a, b, c] : cap) {
    faces.push_back({a, c, b});
    faces.push_back({a + 6, b + 6, c + 6});
  }
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    faces.push_back({i, next, next + 6});
    faces.push_back({i, next + 6, i + 6});
  }
  Shape shape = make_mesh(corners, faces, Eigen::Isometry3d::Identity());
  auto& prism = std::get<Polyhedron>(shape);
  ASSERT_FALSE(prism.convex);
  prism.convex = true;
  const auto lowest_about = [&](double x, double y, double z) {
    // |p - c|^2 is, up to a constant, the cost of a point by its mass, first moments and trace.
    Vector g(10);
    g[0] = exact(x * x + y * y + z * z);
    g[1] = exact(-2.0 * x);
    g[2] = exact(-2.0 * y);
    g[3] = exact(-2.0 * z);
    g[4] = g[7] = g[9] = Rational(1, 2);
    return lowest_in(cost_of_point(g), shape).value;
  };
  EXPECT_EQ(lowest_about(2.0, 0.5, 0.5), 0) << "inside, in front of the notch's face";
  EXPECT_EQ(lowest_about(0.5, 0.5, 0.5), 0) << "inside, behind all";
  EXPECT_EQ(lowest_about(2.0, 2.0, 0.5), 1) << "in the notch: the nearest point of the surface";
  EXPECT_EQ(lowest_about(5.0, 0.5, 0.5), 4) << "outside";
}

/// For cuboids and polyhedra the value is taken at a point of the shape.
RC_GTEST_PROP(Quadric, LowestIsReachedInCuboidsAndPolyhedra, ()) {
  const Vector g = exact(*test::vector(10, 1.0));
  const Shape shape =
      *rc::gen::arbitrary<bool>() ? *test::cuboid_cell() : *test::convex_polyhedron();
  const Quadric q = cost_of_point(g);
  const Lowest lowest = lowest_in(q, shape);
  RC_ASSERT(lowest.value == q.at(lowest.point));
  const Eigen::Vector3d x(lowest.point[0].get_d(), lowest.point[1].get_d(),
                          lowest.point[2].get_d());
  RC_ASSERT(contains(shape, x, 1e-9 * test::reach(shape)));
}

/// The squared distance from a point beyond a face is least within the face, not on its edges.
TEST(Quadric, IsLowestWithinAFace) {
  const double reach = 0.2;
  const Shape octahedron = make_convex_hull({{reach, 0.0, 0.0},
                                             {-reach, 0.0, 0.0},
                                             {0.0, reach, 0.0},
                                             {0.0, -reach, 0.0},
                                             {0.0, 0.0, reach},
                                             {0.0, 0.0, -reach}},
                                            Eigen::Isometry3d::Identity());
  for (const Eigen::Vector3d& signs :
       {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(-1, 1, 1), Eigen::Vector3d(1, -1, -1)}) {
    const Eigen::Vector3d p = signs.cwiseProduct(Eigen::Vector3d(0.3125, 0.25, 0.1875));
    Eigen::VectorXd g(10);  // of (x - p)^2: half the trace of the tensor is x^2
    g << p.squaredNorm(), -2.0 * p, 0.5, 0.0, 0.0, 0.5, 0.0, 0.5;
    const Lowest lowest = lowest_in(cost_of_point(exact(g)), octahedron);
    const Rational beyond = exact(p.cwiseAbs().sum()) - exact(reach);
    EXPECT_EQ(lowest.value, beyond * beyond / 3);
  }
}

/// On balls and cylinders the bound is met to what the enclosing solid costs.
TEST(Quadric, BallsAndCylindersAreNearlyReached) {
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.3, -0.2, 0.1));
  const Shape ball = make_ellipsoid({0.1, 0.1, 0.1}, pose);
  const Shape cylinder = make_cylinder(0.1, 0.4, pose);
  // x + y is lowest on the ball at distance sqrt(2) radius below its centre's value.
  Vector g(10);
  g[1] = g[2] = 1;
  const Quadric q = cost_of_point(g);
  const double truth = 0.1 - 0.1 * std::sqrt(2.0);
  EXPECT_LE(lowest_in(q, ball).value, exact(truth + 1e-15));
  EXPECT_GT(lowest_in(q, ball).value, exact(truth - 1e-9));
  EXPECT_LE(lowest_in(q, cylinder).value, exact(truth + 1e-15));
  EXPECT_GT(lowest_in(q, cylinder).value, exact(truth - 0.003 * 0.1 * std::sqrt(2.0)));
  Vector nothing(10);
  nothing[0] = 3;
  EXPECT_EQ(lowest_in(cost_of_point(nothing), ball).value, 3);
}

/// In a ball the bound is reached: at a point of the ball, to the rounding of the multiplier.
RC_GTEST_PROP(Quadric, LowestIsReachedInBalls, ()) {
  const Quadric q = cost_of_point(exact(*test::vector(10, 1.0)));
  const double radius = *test::magnitude(0.1, 10.0);
  const Lowest lowest = lowest_in_ball(q, exact(radius));
  constexpr double multiplier = 1e-9;
  const Rational square = dot(lowest.point, lowest.point), R = exact(radius);
  RC_ASSERT(square <= R * R * (1 + exact(multiplier)));
  const Rational terms = 20 * (1 + R + R * R);  // of q in the ball
  RC_ASSERT(abs(q.at(lowest.point) - lowest.value) <= exact(multiplier) * terms);
}

/// What a stranger states may be beyond doubles: in other units of cost and of length the bound is
/// the same number, to the last bit.
RC_GTEST_PROP(Quadric, LowestInBallsHasNoUnits, ()) {
  const Quadric q = cost_of_point(exact(*test::vector(10, 1.0)));
  const Rational radius = exact(*test::magnitude(0.1, 10.0));
  const long cost = *rc::gen::inRange(-3000, 3000), length = *rc::gen::inRange(-3000, 3000);
  Quadric other = q;
  for (Rational& entry : other.b) entry = scaled(entry, cost - length);
  for (Vector& row : other.A) {
    for (Rational& entry : row) entry = scaled(entry, cost - 2 * length);
  }
  other.c = scaled(q.c, cost);
  const Lowest here = lowest_in_ball(q, radius);
  const Lowest there = lowest_in_ball(other, scaled(radius, length));
  RC_ASSERT(there.value == scaled(here.value, cost));
  for (std::size_t i = 0; i < 3; ++i) RC_ASSERT(there.point[i] == scaled(here.point[i], length));
}

/// Half the slopes of the data term at Phi.
Vector slopes_at(const MassProblem& p, const Eigen::VectorXd& Phi) {
  return exact(Eigen::VectorXd(p.Y.transpose() * p.W.cwiseProduct(p.Y * Phi - p.F)));
}

TEST(Floor, ClosesInOnTheLimitFromBelow) {
  const StatedProblem p = test::load_problem();
  MassProblem finer = p.masses;  // point masses where the polynomial is lowest, one after another
  finer.lambda = 0.0;
  double reached = reference::solve_masses(finer).value.data;
  const double undivided = reached;
  double floor = 0.0;
  for (int round = 0; round < 60; ++round) {
    const MassSolution solution = reference::solve_masses(finer);
    const auto proved = floor_of_divisions(p, solution.Phi, {});
    ASSERT_TRUE(proved);
    floor = std::max(floor, rounded_down(*proved));
    reached = solution.value.data;
    EXPECT_LT(floor, reached);
    const Quadric cost = cost_of_point(slopes_at(finer, solution.Phi));
    const Lowest lowest = lowest_in(cost, p.regions.front().shape);
    if (sgn(lowest.value) >= 0) break;
    const Eigen::Vector3d x(lowest.point[0].get_d(), lowest.point[1].get_d(),
                            lowest.point[2].get_d());
    finer.U.conservativeResize(Eigen::NoChange, finer.U.cols() + 1);
    finer.U.rightCols<1>() = from_centre(1.0, x, Eigen::Matrix3d::Zero()).values;
    finer.V = Eigen::VectorXd::Ones(finer.U.cols());
  }
  EXPECT_LT(reached, undivided);
  EXPECT_GT(floor, 0.99 * reached);
}

/// With one point and a bound on its mass the floor is the optimum of the data term: (1/8 - 1)^2.
TEST(Floor, IsTheOptimumOfOnePoint) {
  const auto floor = floor_of_divisions(test::one_point_problem(), Eigen::VectorXd::Zero(10), {});
  ASSERT_TRUE(floor);
  EXPECT_EQ(*floor, exact(0.765625));
}

TEST(Floor, NeedsRegionsAndABound) {
  StatedProblem p = test::load_problem();
  const Eigen::VectorXd Phi = p.masses.U.rowwise().mean();
  StatedProblem boundless = p;
  boundless.masses.mass_bound = 0.0;
  EXPECT_FALSE(floor_of_divisions(boundless, Phi, {}));
  p.regions.clear();
  EXPECT_FALSE(floor_of_divisions(p, Phi, {}));
}

}  // namespace
}  // namespace shapeid::certificate
