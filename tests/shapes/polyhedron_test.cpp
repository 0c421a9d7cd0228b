// Polyhedra against cuboids, hulls against meshes, cuts through vertices, solids that are not
// convex.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "shapeid/models/polyhedron.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::own_size;
using test::reach;
using test::scaled;

using Vertices = std::vector<Eigen::Vector3d>;

/// A grid of points on the surface of a box and inside it, with the corners among them.
Vertices box_points(const Eigen::Vector3d& sides, int steps) {
  Vertices points;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= steps; ++j) {
      for (int k = 0; k <= steps; ++k) {
        points.emplace_back((Eigen::Vector3d(i, j, k) / steps - Eigen::Vector3d::Constant(0.5))
                                .cwiseProduct(sides));
      }
    }
  }
  return points;
}

/// The same body, as far as rounding of vertices at their distance from the link origin allows.
void check_same(const Shape& a, const Shape& b) {
  const Moments ma = moments(a);
  const Moments mb = moments(b);
  const double size = own_size(a);
  const double far = reach(a);
  RC_ASSERT(scaled(std::abs(ma.volume - mb.volume), ma.volume + far * size * size, 3) <
            few_hundred_eps);
  RC_ASSERT(scaled((ma.centroid - mb.centroid).norm(), far + far * far * size * size / ma.volume,
                   3) < few_hundred_eps);
  RC_ASSERT(scaled((ma.covariance - mb.covariance).norm(),
                   size * size + far * std::pow(size, 4) / ma.volume, 9) < few_hundred_eps);
}

rc::Gen<Eigen::Vector3d> box_sides() {
  const auto side = test::magnitude(0.05, 1.0);
  return rc::gen::map(rc::gen::tuple(side, side, side), [](const auto& t) {
    return Eigen::Vector3d(std::get<0>(t), std::get<1>(t), std::get<2>(t));
  });
}

// Grid points lie on faces, on edges, in lines: everything that is degenerate for a hull.
RC_GTEST_PROP(Polyhedron, HullOfABoxIsTheCuboid, ()) {
  const Eigen::Vector3d sides = *box_sides();
  const Eigen::Isometry3d pose = *test::pose(0.5);
  const Shape hull = make_convex_hull(box_points(sides, *rc::gen::inRange(1, 4)), pose);
  check_same(hull, make_cuboid(sides, pose));
  RC_ASSERT(std::get<Polyhedron>(hull).vertices.size() == 8U);
  RC_ASSERT(std::get<Polyhedron>(hull).sides.size() == 12U);
}

RC_GTEST_PROP(Polyhedron, PartsOfABoxAreCuboids, ()) {
  const Eigen::Vector3d sides = *box_sides();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = *test::vector3(0.5);
  Shape solid = make_convex_hull(box_points(sides, 1), pose);
  Shape cuboid = make_cuboid(sides, pose);
  for (const test::Cut& cut : *rc::gen::container<std::vector<test::Cut>>(6, test::cut())) {
    const auto solids = divide(solid, cut.axis, cut.fraction);
    const auto cuboids = divide(cuboid, cut.axis, cut.fraction);
    solid = cut.upper ? solids.second : solids.first;
    cuboid = cut.upper ? cuboids.second : cuboids.first;
    check_same(solid, cuboid);
  }
}

RC_GTEST_PROP(Polyhedron, DefaultDivisionOfABoxIsTheCuboids, ()) {
  const Eigen::Isometry3d pose = *test::pose(0.5);
  const Eigen::Vector3d sides(0.2, 0.5, 0.3);
  const auto [a, b] = divide(make_convex_hull(box_points(sides, 1), pose));
  const auto [c, d] = divide(make_cuboid(sides, pose));
  const bool same_order = (moments(a).centroid - moments(c).centroid).norm() <
                          (moments(a).centroid - moments(d).centroid).norm();
  check_same(a, same_order ? c : d);
  check_same(b, same_order ? d : c);
}

RC_GTEST_PROP(Polyhedron, MeshAndHullOfTheSameBodyAgree, ()) {
  const Shape hull = *test::convex_polyhedron();
  const auto& solid = std::get<Polyhedron>(hull);
  const Shape mesh = make_mesh(solid.vertices, triangles(solid), Eigen::Isometry3d::Identity());
  RC_ASSERT(divisible(mesh));
  check_same(mesh, hull);
  check_same(make_convex_hull(solid.vertices, Eigen::Isometry3d::Identity()), hull);
}

RC_GTEST_PROP(Polyhedron, HullHoldsItsPointsAndUsesThem, ()) {
  const Vertices points = *rc::gen::mapcat(rc::gen::inRange(8, 40), [](int count) {
    return rc::gen::container<Vertices>(static_cast<std::size_t>(count), test::vector3(0.5));
  });
  Vertices all = points;
  for (const Eigen::Vector3d& v : box_points({0.2, 0.2, 0.2}, 2)) all.push_back(v);
  const Shape hull = make_convex_hull(all, Eigen::Isometry3d::Identity());
  for (const Eigen::Vector3d& v : all) {
    RC_ASSERT(contains(hull, v, few_hundred_eps * std::numeric_limits<double>::epsilon()));
  }
  for (const Eigen::Vector3d& v : std::get<Polyhedron>(hull).vertices) {
    RC_ASSERT(std::find(all.begin(), all.end(), v) != all.end());
  }
}

// Vertices that no cut touches are copied bit by bit.
RC_GTEST_PROP(Polyhedron, DivisionKeepsVertices, ()) {
  const Shape whole = *test::convex_polyhedron();
  const auto [lower, upper] = divide(whole);
  const auto holds = [](const Shape& shape, const Eigen::Vector3d& v) {
    const Vertices& vertices = std::get<Polyhedron>(shape).vertices;
    return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
  };
  for (const Eigen::Vector3d& v : std::get<Polyhedron>(whole).vertices) {
    RC_ASSERT(holds(lower, v) || holds(upper, v));
  }
}

// Halves of halves to the end of doubles, some 150 of them: a part has no sides but those of the
// whole and one for each cut, and three of them or more meet in every vertex, so that there are no
// more vertices than Euler allows.
RC_GTEST_PROP(Polyhedron, CutsAddOneSideAndNoCornersElsewhere, ()) {
  const Shape whole = *test::convex_polyhedron();
  const auto turns = *rc::gen::container<std::vector<bool>>(200, rc::gen::arbitrary<bool>());
  std::size_t most_sides = std::get<Polyhedron>(whole).sides.size();
  std::optional<std::pair<Shape, Shape>> parts = parts_if_any(whole);
  for (std::size_t cuts = 0; parts; ++cuts) {
    ++most_sides;
    for (const Shape& part : {parts->first, parts->second}) {
      const auto& solid = std::get<Polyhedron>(part);
      RC_ASSERT(solid.sides.size() <= most_sides);
      RC_ASSERT(solid.vertices.size() <= 2 * (solid.sides.size() - 2));
    }
    parts = parts_if_any(turns.at(cuts) ? parts->second : parts->first);
  }
}

// The largest part is halved again and again, as where mass is everywhere: vertices are rounded by
// every cut, and the parts still make up the whole.
RC_GTEST_PROP(Polyhedron, PartsOfManyCutsAddUp, ()) {
  constexpr int cuts = 60;
  const Shape whole = *test::convex_polyhedron();
  std::vector<Shape> parts = {whole};
  for (int cut = 0; cut < cuts; ++cut) {
    const auto largest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Shape& a, const Shape& b) { return volume(a) < volume(b); });
    auto [lower, upper] = divide(*largest);
    *largest = std::move(lower);
    parts.push_back(std::move(upper));
  }

  const Moments m = moments(whole);
  double sum = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Shape& part : parts) {
    const Moments p = moments(part);
    const double share = p.volume / m.volume;
    const Eigen::Vector3d offset = p.centroid - m.centroid;
    sum += share;
    first += share * offset;
    second += share * (p.covariance + offset * offset.transpose());
  }
  const double size = own_size(whole);
  const double rounding = test::volume_rounding(whole);
  RC_ASSERT(scaled(std::abs(sum - 1.0), rounding, cuts) < few_hundred_eps);
  RC_ASSERT(scaled(first.norm(), reach(whole) * rounding, cuts) < few_hundred_eps);
  RC_ASSERT(scaled((second - m.covariance).norm(), size * (size + reach(whole)) * rounding, cuts) <
            few_hundred_eps);
}

// Every direction ties, in any pose: link axis x wins.
RC_GTEST_PROP(Polyhedron, DefaultDivisionOfACubeIsAcrossX, ()) {
  const Shape cube = make_convex_hull(box_points({0.3, 0.3, 0.3}, 1), *test::pose(0.5));
  const auto parts = divide(cube);
  const auto across_x = divide(cube, 0, 0.5);
  check_same(parts.first, across_x.first);
  check_same(parts.second, across_x.second);
}

// In a turned octahedron the plane misses four vertices by roundings only: it counts as through
// them, and no slivers appear.
RC_GTEST_PROP(Polyhedron, CutNearlyThroughVertices, ()) {
  const double a = 0.3 * std::sqrt(0.5);
  const Vertices corners = {{a, a, 0},  {-a, -a, 0}, {a, -a, 0},
                            {-a, a, 0}, {0, 0, 0.5}, {0, 0, -0.5}};
  Eigen::Isometry3d about_z = *test::pose(0.5);
  about_z.linear() = Eigen::AngleAxisd(*test::real(0.0, 6.0), Eigen::Vector3d::UnitZ()).matrix();
  const auto [lower, upper] = divide(make_convex_hull(corners, about_z), 2, 0.5);
  RC_ASSERT(std::get<Polyhedron>(lower).vertices.size() == 5U);
  RC_ASSERT(std::get<Polyhedron>(upper).vertices.size() == 5U);
}

// Powers of two change no digit, so neither does the size of the solid: what counts as rounding
// grows with it.
RC_GTEST_PROP(Polyhedron, PartsScaleWithTheSolid, ()) {
  const Shape whole = *test::convex_polyhedron();
  const test::Cut cut = *test::cut();
  const double scale = std::exp2(*rc::gen::inRange(-12, 13));
  const Shape other = test::mapped(whole, Eigen::Affine3d(Eigen::Scaling(scale)));
  const auto parts = divide(whole, cut.axis, cut.fraction);
  const auto others = divide(other, cut.axis, cut.fraction);
  for (const auto& [part, scaled_part] :
       {std::pair(parts.first, others.first), std::pair(parts.second, others.second)}) {
    const auto& a = std::get<Polyhedron>(part);
    const auto& b = std::get<Polyhedron>(scaled_part);
    RC_ASSERT(a.sides == b.sides);
    RC_ASSERT(a.vertices.size() == b.vertices.size());
    for (std::size_t i = 0; i < a.vertices.size(); ++i) {
      RC_ASSERT(scale * a.vertices[i] == b.vertices[i]);
    }
  }
}

// An octahedron halved across an axis: the plane runs through four vertices and four edges.
TEST(Polyhedron, CutThroughVerticesAndEdges) {
  const Vertices corners = {{0.3, 0, 0},  {-0.3, 0, 0}, {0, 0.4, 0},
                            {0, -0.4, 0}, {0, 0, 0.5},  {0, 0, -0.5}};
  const Shape octahedron = make_convex_hull(corners, Eigen::Isometry3d::Identity());
  for (int axis = 0; axis < 3; ++axis) {
    const auto [lower, upper] = divide(octahedron, axis, 0.5);
    for (const Shape& half : {lower, upper}) {
      EXPECT_FALSE(why_malformed(half));
      EXPECT_EQ(std::get<Polyhedron>(half).vertices.size(), 5U);
      EXPECT_LT(scaled(std::abs(volume(half) - 0.5 * volume(octahedron)), volume(octahedron), 1),
                few_hundred_eps);
    }
  }
}

/// A cuboid whose corner (x > 0, y > 0) is missing, as a mesh with caps of triangles.
Shape notched() {
  const std::vector<std::pair<double, double>> outline = {{-0.2, -0.2}, {0.2, -0.2}, {0.2, 0.0},
                                                          {0.0, 0.0},   {0.0, 0.2},  {-0.2, 0.2}};
  Vertices vertices;
  for (const double z : {-0.1, 0.1}) {
    for (const auto& [x, y] : outline) vertices.emplace_back(x, y, z);
  }
  std::vector<std::array<int, 3>> faces;
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    faces.push_back({i, j, j + 6});
    faces.push_back({i, j + 6, i + 6});
  }
  for (const auto& [a, b, c] :
       std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    faces.push_back({c, b, a});
    faces.push_back({a + 6, b + 6, c + 6});
  }
  return make_mesh(vertices, faces, Eigen::Isometry3d::Identity());
}

// It has no triangle, so that the surface would be closed without it.
TEST(Polyhedron, SideOfTwoVerticesIsNone) {
  auto box = std::get<Polyhedron>(
      make_convex_hull(box_points({0.2, 0.3, 0.4}, 1), Eigen::Isometry3d::Identity()));
  EXPECT_FALSE(why_malformed(Shape(box)));
  box.sides.push_back({0, 1});
  EXPECT_EQ(why_malformed(Shape(box)), "a face has fewer than three vertices");
}

TEST(Polyhedron, NotConvexMeshHasMomentsButDoesNotDivide) {
  const Shape mesh = notched();
  EXPECT_FALSE(divisible(mesh));
  EXPECT_THROW(static_cast<void>(divide(mesh)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(divide(mesh, 0, 0.5)), std::invalid_argument);

  Eigen::Isometry3d left = Eigen::Isometry3d::Identity();
  left.translation() << -0.1, 0.0, 0.0;
  Eigen::Isometry3d right = Eigen::Isometry3d::Identity();
  right.translation() << 0.1, -0.1, 0.0;
  const Shape a = make_cuboid({0.2, 0.4, 0.2}, left);
  const Shape b = make_cuboid({0.2, 0.2, 0.2}, right);
  EXPECT_LT(scaled(std::abs(volume(mesh) - volume(a) - volume(b)), volume(mesh), 2),
            few_hundred_eps);
  const Vector10 sum =
      volume(a) * unit_parameters(a).values + volume(b) * unit_parameters(b).values;
  EXPECT_LT(test::scaled_difference(volume(mesh) * unit_parameters(mesh).values, sum, 10),
            few_hundred_eps);
}

TEST(Polyhedron, NotConvexMeshDoesNotContainItsNotch) {
  const Shape mesh = notched();
  EXPECT_TRUE(contains(mesh, {-0.1, 0.1, 0.0}));
  EXPECT_TRUE(contains(mesh, {0.1, -0.1, 0.05}));
  EXPECT_FALSE(contains(mesh, {0.1, 0.1, 0.0}));
  EXPECT_FALSE(contains(mesh, {0.01, 0.02, 0.0}, 0.0099));
  EXPECT_TRUE(contains(mesh, {0.01, 0.02, 0.0}, 0.0101));
}

// Two boxes apart from each other: every edge is convex, the solid is not.
TEST(Polyhedron, TwoPiecesAreNotConvex) {
  Vertices vertices;
  std::vector<std::array<int, 3>> faces;
  for (const double offset : {0.0, 1.0}) {
    const auto box = std::get<Polyhedron>(
        make_convex_hull(box_points({0.2, 0.3, 0.4}, 1), Eigen::Isometry3d::Identity()));
    const int first = static_cast<int>(vertices.size());
    for (const auto& v : box.vertices) vertices.push_back(v + offset * Eigen::Vector3d::UnitX());
    for (const auto& [a, b, c] : triangles(box)) faces.push_back({a + first, b + first, c + first});
  }
  EXPECT_FALSE(divisible(make_mesh(vertices, faces, Eigen::Isometry3d::Identity())));
}

/// Over a star with five points: no edge is re-entrant, and the middle is held twice.
TEST(Polyhedron, ASurfaceThatWindsTwiceIsNotConvex) {
  const auto over = [](int step) {
    Vertices vertices = {{0.0, 0.0, 0.1}, {0.0, 0.0, -0.1}};
    std::vector<std::array<int, 3>> faces;
    for (int k = 0; k < 5; ++k) {
      const double angle = 2.0 * std::numbers::pi * k * step / 5.0;
      vertices.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0);
      const int a = 2 + k, b = 2 + (k + 1) % 5;
      faces.push_back({a, b, 0});
      faces.push_back({b, a, 1});
    }
    return std::get<Polyhedron>(make_mesh(vertices, faces, Eigen::Isometry3d::Identity()));
  };
  EXPECT_TRUE(divisible(over(1)));
  EXPECT_FALSE(divisible(over(2)));
  EXPECT_NEAR(winding(over(1), Eigen::Vector3d(0.01, 0.02, 0.01)), 1.0, 1e-12);
  EXPECT_NEAR(winding(over(2), Eigen::Vector3d(0.01, 0.02, 0.01)), 2.0, 1e-12);
  EXPECT_NEAR(winding(over(1), Eigen::Vector3d(0.2, 0.1, 0.3)), 0.0, 1e-12);
}

}  // namespace
}  // namespace shapeid
