// Slips that people make with inertias, seeded one by one into a sound link: each must be found,
// and its cause named.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/inertia_lint.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid {
namespace {

struct Numbers {
  double mass;
  Eigen::Vector3d centre;
  std::array<double, 6> six;  ///< ixx ixy ixz iyy iyz izz
};

std::string link_text(const Numbers& n, const std::string& collision = "") {
  return fmt::format(
      "<link name=\"arm\"><inertial><origin xyz=\"{} {} {}\"/><mass value=\"{}\"/><inertia "
      "ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>{}</link>",
      n.centre.x(), n.centre.y(), n.centre.z(), n.mass, n.six[0], n.six[1], n.six[2], n.six[3],
      n.six[4], n.six[5], collision);
}

std::vector<InertiaFinding> findings(const std::string& links) {
  return parse_urdf("<robot name=\"r\">\n" + links + "</robot>", "r.urdf",
                    {.root = Root::floating, .locked = {}, .reject_impossible = false})
      .findings;
}

/// The only finding; a test failure if there is another number of them.
InertiaFinding only(const std::string& links) {
  const auto all = findings(links);
  EXPECT_EQ(all.size(), 1U);
  return all.empty() ? InertiaFinding{} : all.front();
}

std::string box(double x, double y, double z, double at_x = 0.0) {
  return fmt::format(
      "<collision><origin xyz=\"{} 0 0\"/><geometry><box size=\"{} {} {}\"/></geometry>"
      "</collision>",
      at_x, x, y, z);
}

bool names(const InertiaFinding& finding, const char* part) {
  return finding.likely_cause.find(part) != std::string::npos;
}

// A slender arm of 4 kg in skewed axes, its six numbers all different. Each slip below makes it
// impossible.
constexpr std::array<double, 6> arm = {0.073, 0.041, -0.034, 0.088, 0.031, 0.107};
const Eigen::Vector3d elbow(0.15, 0.2, -0.1);

TEST(InertiaLint, SoundLinkHasNoFinding) {
  EXPECT_TRUE(findings(link_text({4.0, elbow, arm})).empty());
}

// The lower triangle by rows (Pinocchio) in URDF's six attributes.
TEST(InertiaLint, LowerTriangleByRows) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found = only(link_text({4.0, elbow, {xx, xy, yy, xz, yz, zz}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "Ixx Ixy Iyy Ixz Iyz Izz")) << found.likely_cause;
}

TEST(InertiaLint, DiagonalFirst) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found = only(link_text({4.0, elbow, {xx, yy, zz, xy, xz, yz}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "Ixx Iyy Izz Ixy Ixz Iyz")) << found.likely_cause;
}

TEST(InertiaLint, ProductsOfSpatialV2) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found = only(link_text({4.0, elbow, {xx, yy, zz, yz, xz, xy}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "Ixx Iyy Izz Iyz Ixz Ixy")) << found.likely_cause;
}

TEST(InertiaLint, WrongSignOfProducts) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found = only(link_text({4.0, elbow, {xx, -xy, -xz, yy, -yz, zz}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "wrong sign")) << found.likely_cause;
}

TEST(InertiaLint, PermutedDiagonal) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found = only(link_text({4.0, elbow, {zz, xy, xz, yy, yz, xx}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "diagonal entries ixx, iyy, izz are permuted")) << found.likely_cause;
}

TEST(InertiaLint, ParallelAxisTermSubtractedOnceMore) {
  const Eigen::Vector3d c = elbow;
  const double m = 4.0;
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const auto found =
      only(link_text({m,
                      c,
                      {xx - m * (c.y() * c.y() + c.z() * c.z()), xy + m * c.x() * c.y(),
                       xz + m * c.x() * c.z(), yy - m * (c.x() * c.x() + c.z() * c.z()),
                       yz + m * c.y() * c.z(), zz - m * (c.x() * c.x() + c.y() * c.y())}}));
  EXPECT_TRUE(found.fatal);
  EXPECT_TRUE(names(found, "parallel axis term was subtracted")) << found.likely_cause;
}

// A tensor about the link's origin is larger, and therefore consistent: only the collision geometry
// tells. A uniform rod of 1 kg and 1 m from the origin along x has 1/12 about its middle, 1/3 about
// its end.
TEST(InertiaLint, TensorAboutTheOrigin) {
  const Eigen::Vector3d middle(0.5, 0, 0);
  const std::string rod = box(1.0, 0.1, 0.1, 0.5);
  EXPECT_TRUE(findings(link_text({1.0, middle, {0.002, 0, 0, 0.0842, 0, 0.0842}}, rod)).empty());
  const auto found = only(link_text({1.0, middle, {0.002, 0, 0, 0.3342, 0, 0.3342}}, rod));
  EXPECT_FALSE(found.fatal);
  EXPECT_EQ(found.likely_cause, "the tensor is about the link's origin, not the centre of mass");
}

TEST(InertiaLint, UnitsOfMoments) {
  const std::string cube = box(0.2, 0.2, 0.3);
  // A uniform block of 2 kg: (0.04 + 0.09) / 6 and (0.04 + 0.04) / 6.
  const double side = 2.0 * (0.04 + 0.09) / 12.0;
  const double end = 2.0 * (0.04 + 0.04) / 12.0;
  EXPECT_TRUE(findings(link_text({2.0, {0, 0, 0}, {side, 0, 0, side, 0, end}}, cube)).empty());
  for (const auto& [unit, in_si] : std::vector<std::pair<const char*, double>>{
           {"g mm^2", 1e-9}, {"kg mm^2", 1e-6}, {"kg cm^2", 1e-4}, {"g m^2", 1e-3}}) {
    const double s = side / in_si;
    const double e = end / in_si;
    const auto found = only(link_text({2.0, {0, 0, 0}, {s, 0, 0, s, 0, e}}, cube));
    EXPECT_FALSE(found.fatal);
    EXPECT_TRUE(names(found, unit)) << unit << ": " << found.likely_cause;
  }
}

TEST(InertiaLint, CentreInMillimetres) {
  const auto found =
      only(link_text({2.0, {50, 0, 0}, {0.02, 0, 0, 0.02, 0, 0.01}}, box(0.3, 0.2, 0.2)));
  EXPECT_FALSE(found.fatal);
  EXPECT_EQ(found.likely_cause, "the centre of mass is in mm, not m");
}

// Drawn as a sheet: a tenth of its length is taken for its thickness, and its length once more in
// every direction is forgiven.
TEST(InertiaLint, CentreFarFromASheet) {
  const std::string sheet = box(0.3, 0.2, 0.0);
  const std::array<double, 6> small = {0.001, 0, 0, 0.001, 0, 0.001};
  EXPECT_TRUE(findings(link_text({1.0, {0, 0, 0.31}, small}, sheet)).empty());
  const auto found = only(link_text({1.0, {0, 0, 0.32}, small}, sheet));
  EXPECT_EQ(found.wrong, "the centre of mass (0, 0, 0.32) m is far outside the collision geometry");
}

TEST(InertiaLint, Placeholders) {
  const auto identity = only(link_text({1.0, {0, 0, 0}, {1, 0, 0, 1, 0, 1}}));
  EXPECT_FALSE(identity.fatal);
  EXPECT_EQ(identity.wrong, "the tensor is the identity, 1 kg m^2 about each axis");
  const auto point = only(link_text({1.0, {0, 0, 0}, {0, 0, 0, 0, 0, 0}}));
  EXPECT_FALSE(point.fatal);
  EXPECT_EQ(point.likely_cause, "the moments were left out");
  const auto equal = only(link_text({1e-6, {0, 0, 0}, {1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6}}));
  EXPECT_TRUE(equal.fatal);
  EXPECT_EQ(equal.likely_cause, "a placeholder; products of inertia belong to zero there");
}

// 0.0123 + 0.0045 = 0.0168: short by one in the last digit, as rounding leaves it.
TEST(InertiaLint, RoundingIsForgivenAndNamed) {
  const auto rounded = only(link_text({1.0, {0, 0, 0}, {0.0123, 0, 0, 0.0045, 0, 0.0169}}));
  EXPECT_FALSE(rounded.fatal);
  EXPECT_EQ(rounded.likely_cause, "the moments were rounded; write more digits");
  const auto broken = only(link_text({1.0, {0, 0, 0}, {0.0123, 0, 0, 0.0045, 0, 0.0179}}));
  EXPECT_TRUE(broken.fatal);
  EXPECT_EQ(broken.likely_cause, "");
}

// Each moment as far as its own digits go: 0.05 for 0.2, 0.005 for 0.31, 0.00005 for the largest.
TEST(InertiaLint, RoundingIsThatOfEachMoment) {
  constexpr double rough = 0.2, fine = 0.31;
  const auto blames_rounding = [](double xx, double yy, double zz) {
    return names(only(link_text({1.0, {0, 0, 0}, {xx, 0, 0, yy, 0, zz}})), "rounded");
  };
  for (const auto& [largest, rounded] : {std::pair(0.5645, true), std::pair(0.5655, false)}) {
    EXPECT_EQ(blames_rounding(rough, fine, largest), rounded);
    EXPECT_EQ(blames_rounding(fine, largest, rough), rounded);
    EXPECT_EQ(blames_rounding(largest, rough, fine), rounded);
  }
}

// Blanks beside a number are no digits: 0.00005 and as much again explain 0.00008.
TEST(InertiaLint, BlanksAreNoDigits) {
  const std::string text =
      "<link name=\"arm\"><inertial><mass value=\"1\"/><inertia ixx=\"0.0123  \" ixy=\"0\" "
      "ixz=\"0\" iyy=\"0.0045\" iyz=\"0\" izz=\"0.01688\"/></inertial></link>";
  EXPECT_TRUE(names(only(text), "rounded"));
}

// Axis-aligned, wherever and however the bodies are placed; powers of two, so exactly.
TEST(CollisionExtent, HoldsAllBodies) {
  Eigen::Isometry3d pose(Eigen::Translation3d(8.0, 16.0, 32.0));
  pose.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y, y to z, z to x
  const auto check = [](const std::vector<CollisionBody>& bodies, const Eigen::Vector3d& lower,
                        const Eigen::Vector3d& upper) {
    urdf::DocumentLink link;
    link.collision = bodies;
    const auto extent = urdf::collision_extent(link);
    ASSERT_TRUE(extent);
    EXPECT_EQ(extent->lower, lower);
    EXPECT_EQ(extent->upper, upper);
  };
  const CollisionBody cylinder{pose, CylinderGeometry{0.25, 1.0}};
  const CollisionBody box{pose, Box{{1.0, 2.0, 4.0}}};
  const CollisionBody sphere{Eigen::Isometry3d::Identity(), SphereGeometry{0.5}};
  check({cylinder}, {7.5, 15.75, 31.75}, {8.5, 16.25, 32.25});
  check({box}, {6.0, 15.5, 31.0}, {10.0, 16.5, 33.0});
  check({sphere}, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  check({sphere, cylinder, box}, {-0.5, -0.5, -0.5}, {10.0, 16.5, 33.0});
  urdf::DocumentLink link;
  EXPECT_FALSE(urdf::collision_extent(link));
  link.collision.resize(2);
  link.collision[0].geometry = MeshGeometry{};
  EXPECT_FALSE(urdf::collision_extent(link));
}

// An impossible frame of 1e-6 kg on a trunk that can exist is said, and forgiven.
TEST(InertiaLint, ImpossibleMemberOfASoundBodyIsForgiven) {
  const std::string trunk =
      "<link name=\"trunk\"><inertial><mass value=\"5\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/></inertial></link>"
      "<joint name=\"j\" type=\"fixed\"><parent link=\"trunk\"/><child link=\"arm\"/></joint>\n";
  const Numbers small{1e-6, {0, 0, 0}, {1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6}};
  EXPECT_FALSE(only(trunk + link_text(small)).fatal);
  const Numbers large{5.0, {0, 0, 0}, {1, 1, 1, 1, 1, 1}};
  EXPECT_TRUE(only(trunk + link_text(large)).fatal);
}

TEST(InertiaLint, MessageOfARefusedFileNamesLinkInequalityAndCause) {
  const auto [xx, xy, xz, yy, yz, zz] = arm;
  const std::string text =
      "<robot name=\"r\">\n" + link_text({4.0, elbow, {xx, -xy, -xz, yy, -yz, zz}}) + "</robot>";
  try {
    static_cast<void>(parse_urdf(text, "r.urdf"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "r.urdf:2: inertia of link arm: the triangle inequality is broken: principal "
        "moments 0.0379357 + 0.0691296 < 0.160935 kg m^2 (short by 0.0538694) (likely: the "
        "products of inertia have the wrong sign (URDF's ixy is minus the integral of x "
        "y)); correct it, leave it out, or read it with reject_impossible = false where the link "
        "is "
        "known");
  }
}

}  // namespace
}  // namespace shapeid
