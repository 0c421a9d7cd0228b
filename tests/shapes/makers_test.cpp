// What the makers refuse, and which side the default division cuts.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "shapeid/models/shape.hpp"
#include "shapeid/models/shape_size.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();

using Vertices = std::vector<Eigen::Vector3d>;
using Faces = std::vector<std::array<int, 3>>;
const Vertices corner = {{0, 0, 0}, {0.2, 0, 0}, {0, 0.5, 0}, {0, 0, 0.9}};
const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

TEST(Makers, RefuseSizesThatAreNotPositiveAndFinite) {
  for (const double bad : {0.0, -0.1, nan, infinity}) {
    EXPECT_THROW(static_cast<void>(make_cuboid({0.1, bad, 0.2}, here)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(make_cylinder(bad, 0.2, here)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(make_cylinder(0.2, bad, here)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(make_ellipsoid({0.1, 0.2, bad}, here)), std::invalid_argument);
    EXPECT_THROW(static_cast<void>(make_point({0.1, 0.2, 0.3}, bad)), std::invalid_argument);
  }
  EXPECT_THROW(static_cast<void>(make_point({0.1, nan, 0.3}, 1e-6)), std::invalid_argument);
}

TEST(Makers, RefusePosesThatAreNotFinite) {
  Eigen::Isometry3d nowhere = here;
  nowhere.translation() << 0, nan, 0;
  EXPECT_THROW(static_cast<void>(make_cuboid({0.1, 0.1, 0.2}, nowhere)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_convex_hull(corner, nowhere)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_mesh(corner, tetrahedron, nowhere)), std::invalid_argument);
}

/// The reason that a mesh is refused for.
std::string refusal(const Vertices& vertices, const Faces& faces) {
  try {
    static_cast<void>(make_mesh(vertices, faces, here));
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Makers, AcceptATetrahedron) {
  EXPECT_EQ(refusal(corner, tetrahedron), "accepted");
  EXPECT_TRUE(divisible(make_mesh(corner, tetrahedron, here)));
}

TEST(Makers, RefuseOpenMeshes) {
  EXPECT_NE(refusal(corner, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}).find("four faces"),
            std::string::npos);
  Faces open = tetrahedron;
  open.push_back({0, 1, 2});
  EXPECT_NE(refusal(corner, open).find("open"), std::string::npos);
}

TEST(Makers, RefuseMeshesOfMixedOrientation) {
  Faces mixed = tetrahedron;
  std::swap(mixed[2][0], mixed[2][1]);
  EXPECT_NE(refusal(corner, mixed).find("inconsistently"), std::string::npos);
}

TEST(Makers, RefuseMeshesThatAreInsideOut) {
  Faces reversed = tetrahedron;
  for (auto& face : reversed) std::swap(face[0], face[1]);
  EXPECT_NE(refusal(corner, reversed).find("inside out"), std::string::npos);
}

/// Half of a mirrored part: the whole has a volume, and no body has its inertia.
TEST(Makers, ShellsThatFaceInwardsAreNoBody) {
  Vertices both = corner;
  Faces faces = tetrahedron;
  for (const Eigen::Vector3d& v : corner) both.push_back(0.5 * v + Eigen::Vector3d(0.0, 9.0, 0.0));
  const int first = static_cast<int>(corner.size());
  for (const auto& [a, b, c] : tetrahedron) faces.push_back({b + first, a + first, c + first});
  const Violation why = why_no_size(make_mesh(both, faces, here));
  ASSERT_TRUE(why);
  EXPECT_NE(why->find("is no body"), std::string::npos) << *why;
  for (std::size_t f = tetrahedron.size(); f < faces.size(); ++f) {
    std::swap(faces[f][0], faces[f][1]);
  }
  EXPECT_FALSE(why_no_size(make_mesh(both, faces, here)));
}

TEST(Makers, RefuseMeshesWithoutVolume) {
  // In most poses rounding gives the flat surface a volume of some sign.
  for (int i = 0; i < 50; ++i) {
    const auto turn = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(3, -1, 2).normalized());
    Vertices flat = {{0, 0, 0}, {1, 0, 0.1}, {0, 1, 0.1}, {1, 0.9, 0.19}};
    for (Eigen::Vector3d& v : flat) v = turn * v + Eigen::Vector3d(0.3, 0.1, -0.2);
    EXPECT_NE(refusal(flat, tetrahedron).find("no volume"), std::string::npos);
  }
}

TEST(Makers, RefuseMeshesWithWrongIndices) {
  Faces wrong = tetrahedron;
  wrong[0][0] = 4;
  EXPECT_NE(refusal(corner, wrong).find("none of the 4"), std::string::npos);
  wrong[0][0] = -1;
  EXPECT_NE(refusal(corner, wrong).find("none of the 4"), std::string::npos);
  wrong[0][0] = wrong[0][1];
  EXPECT_NE(refusal(corner, wrong).find("twice"), std::string::npos);
}

TEST(Makers, RefuseHullsWithoutASolid) {
  EXPECT_THROW(static_cast<void>(make_convex_hull({}, here)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, here)),
               std::invalid_argument);
  Vertices same(5, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_THROW(static_cast<void>(make_convex_hull(same, here)), std::invalid_argument);
  Vertices line;
  Vertices plane;
  for (int i = 0; i < 6; ++i) {
    const double t = 0.1 * i;
    line.emplace_back(t, 0.3 - 2.0 * t, 0.7 * t);
    plane.emplace_back(t, std::sin(7.0 * t), 0.3 * t - 0.9 * std::sin(7.0 * t) + 0.2);
  }
  EXPECT_THROW(static_cast<void>(make_convex_hull(line, here)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_convex_hull(plane, here)), std::invalid_argument);
}

TEST(Division, RefusesWhatItCannotDo) {
  const Shape box = make_cuboid({0.1, 0.2, 0.3}, here);
  EXPECT_THROW(static_cast<void>(divide(box, 3, 0.5)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(divide(box, -1, 0.5)), std::invalid_argument);
  for (const double bad : {0.0, 1.0, -0.5, 1.5, nan}) {
    EXPECT_THROW(static_cast<void>(divide(box, 0, bad)), std::invalid_argument);
  }
  const Shape point = make_point({0.1, 0.2, 0.3}, 1e-6);
  EXPECT_FALSE(divisible(point));
  EXPECT_THROW(static_cast<void>(divide(point)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(divide(point, 0, 0.5)), std::invalid_argument);
}

TEST(Division, EndsWhereDoublesEnd) {
  Shape slice = make_cuboid({0.1, 0.2, 0.3}, here);
  const auto forever = [&] {
    for (int i = 0; i < 2000; ++i) slice = divide(slice, 0, 0.5).second;
  };
  EXPECT_THROW(forever(), std::invalid_argument);
  EXPECT_FALSE(why_malformed(slice));
}

/// Which coordinate of the cell the default division cuts.
template <typename Kind>
int axis_cut(const Shape& shape) {
  const Cell& before = std::get<Kind>(shape).cell;
  const Cell after = std::get<Kind>(divide(shape).first).cell;
  for (int axis = 0; axis < 3; ++axis) {
    if (after.upper[axis] != before.upper[axis]) return axis;
  }
  return -1;
}

TEST(LongestSide, OfACuboid) {
  EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.3, 0.2, 0.1}, here)), 0);
  EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.2, 0.3, 0.1}, here)), 1);
  EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.2, 0.1, 0.3}, here)), 2);
  EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.2, 0.2, 0.2}, here)), 0);
  EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.1, 0.2, 0.2}, here)), 1);
}

TEST(LongestSide, TiesThatOnlyRoundingBreaksAreTies) {
  Eigen::Isometry3d turned = here;
  for (int i = 1; i < 50; ++i) {
    turned.linear() = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(3, -1, 2).normalized()).matrix();
    EXPECT_EQ(axis_cut<Cuboid>(make_cuboid({0.3, 0.3, 0.3}, turned)), 0);
  }
}

// Radius 0.1: the outer arc of a whole turn measures 0.628, of a half 0.314, of a quarter 0.157.
TEST(LongestSide, OfACylinder) {
  EXPECT_EQ(axis_cut<Cylinder>(make_cylinder(0.1, 0.62, here)), 1);
  EXPECT_EQ(axis_cut<Cylinder>(make_cylinder(0.1, 0.64, here)), 2);
  const Shape half = divide(make_cylinder(0.1, 0.05, here)).first;
  EXPECT_EQ(axis_cut<Cylinder>(half), 1);
  const Shape eighth = divide(divide(half).first).first;
  EXPECT_EQ(axis_cut<Cylinder>(eighth), 0);  // 0.079 of arc, 0.1 of radius
}

// A ball is cut into halves, quarters, then eighths of an orange with three arcs; the arc of the
// half measures as much in polar angle as in azimuth, and the lowest axis is cut.
TEST(LongestSide, OfABall) {
  const Shape ball = make_ellipsoid({0.1, 0.1, 0.1}, here);
  EXPECT_EQ(axis_cut<Ellipsoid>(ball), 2);
  const Shape half = divide(ball).first;
  EXPECT_EQ(axis_cut<Ellipsoid>(half), 1);
  EXPECT_EQ(axis_cut<Ellipsoid>(divide(half).first), 2);
}

// The cap that holds a thousandth of a ball reaches 0.063 rad down: its widest parallel measures
// 0.04.
TEST(LongestSide, OfACap) {
  const Shape cap = divide(make_ellipsoid({0.1, 0.1, 0.1}, here), 1, 0.001).first;
  EXPECT_EQ(axis_cut<Ellipsoid>(cap), 0);
}

// A cigar along z: its meridians are long, its parallels short.
TEST(LongestSide, OfAStretchedBall) {
  EXPECT_EQ(axis_cut<Ellipsoid>(make_ellipsoid({0.1, 0.1, 1.0}, here)), 1);
  EXPECT_EQ(axis_cut<Ellipsoid>(make_ellipsoid({1.0, 1.0, 0.1}, here)), 2);
}

}  // namespace
}  // namespace shapeid
