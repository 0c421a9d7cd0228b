#include "shapeid/models/shapes_yaml.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/robot/two_link_robot.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

constexpr std::array<std::array<float, 3>, 4> tetrahedron = {
    {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 4}}};
constexpr std::array<std::array<std::size_t, 3>, 4> faces = {
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

std::string ascii_stl(std::size_t face_count = 4) {
  std::string text = "solid a name of words\n";
  for (std::size_t f = 0; f < face_count; ++f) {
    const auto& face = faces[f];
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::size_t i : face) {
      text +=
          fmt::format("vertex {} {} {}\n", tetrahedron[i][0], tetrahedron[i][1], tetrahedron[i][2]);
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string little_endian(std::uint32_t value) {
  std::string bytes;
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8U * i) & 0xFFU);
  return bytes;
}

/// With a header that begins as an ASCII file does, as some exporters write.
std::string binary_stl() {
  std::string bytes = "solid";
  bytes.resize(80, ' ');
  bytes += little_endian(4);
  for (const auto& face : faces) {
    bytes += std::string(12, '\0');
    for (const std::size_t i : face) {
      for (const float x : tetrahedron[i]) bytes += little_endian(std::bit_cast<std::uint32_t>(x));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

/// As exporters of assemblies write: a solid for each part.
TEST(ShapesYaml, AllSolidsOfAFileAreItsMesh) {
  const test::ScratchFolder folder;
  std::string parts = ascii_stl();
  const std::string facet = "endfacet\n";
  parts.insert(parts.find(facet) + facet.size(),
               "endsolid a name\n\nsolid another name of words\n");
  const std::string path =
      folder.write("shapes.yaml", "leg:\n  - {kind: polyhedron, mesh: a.stl}\n");
  folder.write("a.stl", ascii_stl());
  const BodyModel whole = read_shapes_yaml(path, test::two_link_robot());
  folder.write("a.stl", parts);
  const BodyModel apart = read_shapes_yaml(path, test::two_link_robot());
  EXPECT_EQ(unit_parameters(apart.shapes.at(0).shape).values,
            unit_parameters(whole.shapes.at(0).shape).values);
  EXPECT_EQ(volume(apart.shapes.at(0).shape), volume(whole.shapes.at(0).shape));
}

TEST(ShapesYaml, EveryKindIsReadInItsPlace) {
  const test::ScratchFolder folder;
  folder.write("a.stl", ascii_stl());
  folder.write("b.stl", binary_stl());
  const std::string path = folder.write("shapes.yaml", R"(
leg: known
plate:
  - {kind: cuboid, size: [1, 2, 3], pose: {xyz: [1, 0, 0]}}
trunk:
  - {kind: cylinder, size: [0.5, 2], pose: {rpy: [1.5707963267948966, 0, 0]}}
  - {kind: ellipsoid, size: [1, 2, 3]}
  - {kind: polyhedron, vertices: [[0,0,0], [2,0,0], [0,3,0], [0,0,4]]}
  - {kind: polyhedron, mesh: a.stl}
  - {kind: polyhedron, mesh: b.stl, scale: 0.5, hull: true}
  - {kind: point, volume: 0.001, pose: {xyz: [7, 8, 9]}}
)");
  const Robot robot = test::two_link_robot();
  const BodyModel model = read_shapes_yaml(path, robot);
  EXPECT_FALSE(why_malformed(model, robot));
  EXPECT_EQ(model.free_links, std::vector<int>{0});
  EXPECT_TRUE(model.known.head<10>().isZero(0.0));
  EXPECT_EQ(model.known.tail<10>(), robot.links[1].inertia.values);

  const double pi = std::acos(-1.0);
  const std::vector<double> volumes = {6, 0.5 * pi, 8 * pi, 4, 4, 0.5, 0.001};
  ASSERT_EQ(model.shapes.size(), volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    EXPECT_EQ(model.shapes[i].id, std::to_string(i));
    EXPECT_EQ(model.shapes[i].link, 0);
    EXPECT_LT(test::scaled(std::abs(volume(model.shapes[i].shape) - volumes[i]), volumes[i], 10),
              few_hundred_eps)
        << i;
  }
  // The plate's frame is turned by 90 degrees about z and stands at (1, 2, 3): its x is our y.
  const InertialParameters cuboid = unit_parameters(model.shapes[0].shape);
  EXPECT_LT(scaled_difference(cuboid.first_moment(), Eigen::Vector3d(1, 3, 3), 3), few_hundred_eps);
  // Sides 1 2 3 along plate x y z: about the centre Ixx = (1 + 9)/12 along trunk x.
  EXPECT_LT(test::scaled(std::abs(cuboid.tensor_about_centre()(0, 0) - 10.0 / 12.0),
                         cuboid.values.norm(), 10),
            few_hundred_eps);
  // The cylinder lies along y: Iyy = r^2 / 2.
  EXPECT_LT(test::scaled(std::abs(unit_parameters(model.shapes[1].shape).tensor()(1, 1) - 0.125),
                         1.0, 10),
            few_hundred_eps);
  EXPECT_EQ(unit_parameters(model.shapes[6].shape).first_moment(), Eigen::Vector3d(7, 8, 9));
  // Centroid of a tetrahedron: mean of its corners.
  const Eigen::Vector3d centroid(0.5, 0.75, 1.0);
  for (const auto& [shape, scale] : {std::pair(3, 1.0), std::pair(4, 1.0), std::pair(5, 0.5)}) {
    const auto unit = unit_parameters(model.shapes[static_cast<std::size_t>(shape)].shape);
    EXPECT_LT(scaled_difference(unit.first_moment(), scale * centroid, 10), few_hundred_eps);
  }
}

TEST(ShapesYaml, RefusalsSayLineWrongAndRight) {
  struct Broken {
    const char* text;
    const char* message;
  };
  const std::vector<Broken> cases = {
      {"", "shapes.yaml: shapes.yaml is not a map; write lines of key: value"},
      {"hip: known\n", "shapes.yaml:1: hopper has no link hip; name a link"},
      {"leg: unknown\n",
       "shapes.yaml:1: leg is neither known nor a list of shapes; write known, or - {kind: cuboid, "
       "size: [x, y, z]}"},
      {"leg: []\n",
       "shapes.yaml:1: leg is neither known nor a list of shapes; write known, or - {kind: cuboid, "
       "size: [x, y, z]}"},
      {"leg: known\n",
       "shapes.yaml:1: every link is known, so nothing is sought; give one link a list of shapes"},
      {"leg: known\nleg: known\n",
       "shapes.yaml:2: leg is named twice in shapes.yaml; name it once"},
      {"trunk:\n  - {kind: cuboid, size: [1, 1, 1]}\nplate: known\n",
       "shapes.yaml:3: plate is one rigid body with a link named before, which says otherwise; "
       "make both known, or give both shapes"},
      {"leg:\n  - cuboid\n",
       "shapes.yaml:2: a shape has no kind; write {kind: cuboid, size: [x, y, z]}"},
      {"leg:\n  - {size: [1, 1, 1]}\n",
       "shapes.yaml:2: a shape has no kind; write {kind: cuboid, size: [x, y, z]}"},
      {"leg:\n  - {kind: cube, size: [1, 1, 1]}\n",
       "shapes.yaml:2: there is no shape of kind cube; cuboid, cylinder, ellipsoid, polyhedron or "
       "point"},
      {"leg:\n  - {kind: cuboid}\n",
       "shapes.yaml:2: a cuboid does not give its size; it needs kind, size"},
      {"leg:\n  - {kind: cuboid, size: [1, 1]}\n",
       "shapes.yaml:2: size is not a list of 3 numbers; write them in brackets, with commas "
       "between them"},
      {"leg:\n  - {kind: cuboid, size: [1, 1, 0]}\n",
       "shapes.yaml:2: sides of a cuboid must be positive and finite, not 1 1 0; give a solid with "
       "a positive volume"},
      {"leg:\n  - {kind: cuboid, size: [1, 1, inf]}\n",
       "shapes.yaml:2: size is not a finite number (\"inf\"); write a finite decimal number"},
      {"leg:\n  - {kind: cuboid, size: [1, 1, 1], mass: 2}\n",
       "shapes.yaml:2: a cuboid has no key mass; it has kind, size, pose"},
      {"leg:\n  - {kind: cylinder, size: [1, 1, 1]}\n",
       "shapes.yaml:2: size (radius, length) is not a list of 2 numbers; write them in brackets, "
       "with commas between them"},
      {"leg:\n  - {kind: cylinder, size: [1, -1]}\n",
       "shapes.yaml:2: radius, radius and length of a cylinder must be positive and finite, not 1 "
       "1 -1; give a solid with a positive volume"},
      {"leg:\n  - {kind: point}\n",
       "shapes.yaml:2: a point does not give its volume; it needs kind, volume"},
      {"leg:\n  - {kind: point, volume: 0}\n", "shapes.yaml:2: volume is 0; it must be above zero"},
      {"leg:\n  - {kind: cuboid, size: [1, 1, 1], pose: {xyz: 1}}\n",
       "shapes.yaml:2: pose xyz is not a list of 3 numbers; write them in brackets, with commas "
       "between them"},
      {"leg:\n  - {kind: polyhedron}\n",
       "shapes.yaml:2: a polyhedron has no vertices and no mesh; give one of them"},
      {"leg:\n  - {kind: polyhedron, vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}\n",
       "shapes.yaml:2: the points span no solid: they lie in a plane, or on a line; give a solid "
       "with a positive volume"},
      {"leg:\n  - {kind: polyhedron, vertices: [[-0.3, 1e-4, -1e-4], [0.01, -0.3, 0], [0, 0, 0], "
       "[0, -1e-4, 0]]}\n",
       "shapes.yaml:2: the solid is too thin for its place: rounding would change its volume; a "
       "thicker solid, or one that is nearer to its link's origin"},
      {"leg:\n  - {kind: polyhedron, vertices: [[0, 0, 0]], mesh: a.stl}\n",
       "shapes.yaml:2: a polyhedron has both vertices and a mesh; give one of them"},
      {"leg:\n  - {kind: polyhedron, vertices: 3}\n",
       "shapes.yaml:2: vertices is not a list; write [[x, y, z], ...]"},
      {"leg:\n  - {kind: polyhedron, mesh: ends.stl}\n",
       "ends.stl:30: \"end\" is not STL here; expected facet or endsolid"},
      {"leg:\n  - {kind: polyhedron, mesh: none.stl}\n",
       "none.stl: no such file, or not a regular one; check the path"},
      {"leg:\n  - {kind: polyhedron, mesh: open.stl}\n",
       "shapes.yaml:2: mesh: a closed surface has at least four faces; give a solid with a "
       "positive volume"},
      {"leg:\n  - {kind: polyhedron, mesh: word.stl}\n",
       "word.stl:6: \"two\" is not STL here; expected a finite number"},
      {"leg:\n  - {kind: polyhedron, mesh: after.stl}\n",
       "after.stl:31: \"remarks\" is not STL here; expected another solid or the end"},
      {"leg:\n  - {kind: polyhedron, mesh: short.stl}\n",
       "short.stl: neither a binary STL (its size does not fit its count of triangles) nor an "
       "ASCII one; export the mesh as STL"},
      {"leg:\n  - {kind: polyhedron, mesh: good.stl, hull: maybe}\n",
       "shapes.yaml:2: hull is maybe; true or false"},
      {"leg:\n  - {kind: polyhedron, mesh: good.stl, scale: 0}\n",
       "shapes.yaml:2: scale is 0; it must be above zero"},
  };
  const test::ScratchFolder folder;
  folder.write("good.stl", ascii_stl());
  folder.write("open.stl", ascii_stl(3));
  std::string bad = ascii_stl();
  folder.write("word.stl", bad.replace(bad.find("vertex 2"), 8, "vertex two"));
  std::string ends = ascii_stl();
  folder.write("ends.stl", ends.replace(ends.find("endsolid"), 8, "end"));
  folder.write("after.stl", ascii_stl() + "remarks\n");
  folder.write("short.stl", binary_stl().substr(6));
  const Robot robot = test::two_link_robot();
  for (const Broken& broken : cases) {
    const std::string path = folder.write("shapes.yaml", broken.text);
    try {
      static_cast<void>(read_shapes_yaml(path, robot));
      ADD_FAILURE() << "accepted: " << broken.text;
    } catch (const InputError& error) {
      const std::string where = folder.path("");
      EXPECT_EQ(std::string(error.what()).substr(where.size()), broken.message) << broken.text;
    }
  }
}

TEST(DefaultShapes, CollisionPrimitivesBecomeShapes) {
  const Robot robot = test::two_link_robot();
  const BodyModel model = default_shapes(robot, {0});
  EXPECT_FALSE(why_malformed(model, robot));
  ASSERT_EQ(model.shapes.size(), 3U);  // the flat box has no volume
  EXPECT_EQ(kind_name(model.shapes[0].shape), "cuboid");
  EXPECT_EQ(unit_parameters(model.shapes[0].shape).first_moment(), Eigen::Vector3d(0, 0, 0.5));
  EXPECT_EQ(kind_name(model.shapes[1].shape), "cylinder");
  EXPECT_EQ(kind_name(model.shapes[2].shape), "ellipsoid");
}

/// Second moments of a kilogram about the centre along the body's own axes, turned and moved.
Vector10 placed(const Eigen::Vector3d& own, const Eigen::Matrix3d& R, const Eigen::Vector3d& c) {
  const Eigen::Matrix3d second = R * own.asDiagonal() * R.transpose() + c * c.transpose();
  const Eigen::Matrix3d I = second.trace() * Eigen::Matrix3d::Identity() - second;
  Vector10 Phi;
  Phi << 1, c, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
  return Phi;
}

TEST(DefaultShapes, CollisionPrimitivesKeepTheirSizesAndPoses) {
  const Robot robot = parse_urdf(R"(<robot name="trunk"><link name="trunk">
    <inertial><mass value="3"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial>
    <collision><origin xyz="0.1 -0.2 0.3" rpy="0.4 -0.5 0.6"/>
      <geometry><box size="0.2 0.3 0.7"/></geometry></collision>
    <collision><origin xyz="-0.3 0.1 0.2" rpy="-0.7 0.9 1.1"/>
      <geometry><cylinder radius="0.15" length="0.8"/></geometry></collision>
    <collision><origin xyz="0.2 0.4 -0.1" rpy="0.3 0.2 0.1"/>
      <geometry><sphere radius="0.25"/></geometry></collision>
  </link></robot>)",
                                 "trunk.urdf")
                          .robot;
  const auto turned = [](double roll, double pitch, double yaw) {
    return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  };
  const double a = 0.2, b = 0.3, c = 0.7;    // box
  const double r = 0.15, h = 0.8, R = 0.25;  // cylinder, ball
  const double pi = std::numbers::pi;
  const std::array<double, 3> volumes = {a * b * c, pi * r * r * h, 4.0 / 3.0 * pi * R * R * R};
  const std::array<Vector10, 3> wanted = {
      placed(Eigen::Vector3d(a * a, b * b, c * c) / 12.0, turned(0.4, -0.5, 0.6), {0.1, -0.2, 0.3}),
      placed({r * r / 4.0, r * r / 4.0, h * h / 12.0}, turned(-0.7, 0.9, 1.1), {-0.3, 0.1, 0.2}),
      placed(Eigen::Vector3d::Constant(R * R / 5.0), turned(0.3, 0.2, 0.1), {0.2, 0.4, -0.1})};
  const BodyModel model = default_shapes(robot, {0});
  ASSERT_EQ(model.shapes.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const Shape& shape = model.shapes[i].shape;
    EXPECT_LT(test::scaled(std::abs(volume(shape) - volumes[i]), volumes[i], 10), few_hundred_eps);
    EXPECT_LT(scaled_difference(unit_parameters(shape).values, wanted[i], 10), few_hundred_eps);
  }
}

// The leg is a uniform cuboid of 1 kg. Its squared sides, 12 (Iyy + Izz - Ixx) / 2 and so on, by
// hand from the URDF: 0.01, 0.035, 0.115.
TEST(DefaultShapes, MeshBecomesTheCuboidOfTheGivenInertia) {
  const Robot robot = test::two_link_robot();
  const BodyModel model = default_shapes(robot, {1, 1});
  EXPECT_EQ(model.free_links, std::vector<int>{1});
  ASSERT_EQ(model.shapes.size(), 1U);
  EXPECT_LT(scaled_difference(unit_parameters(model.shapes[0].shape).values,
                              robot.links[1].inertia.values, 10),
            few_hundred_eps);
  const double expected = std::sqrt(0.01 * 0.035 * 0.115);
  EXPECT_LT(test::scaled(std::abs(volume(model.shapes[0].shape) - expected), expected, 10),
            few_hundred_eps);
}

TEST(DefaultShapes, LinkWithNothingIsRefused) {
  Robot robot = test::two_link_robot();
  robot.links[1].inertia = {};
  try {
    static_cast<void>(default_shapes(robot, {1}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "link leg has a mesh for collision geometry, and no inertia of a solid to make a "
                 "cuboid of; describe it in shapes.yaml");
  }
}

TEST(LoadRegion, OneCuboidOnTopOfWhatIsKnown) {
  const Robot robot = test::two_link_robot();
  const LinkSite plate = robot.find_site("plate").value();
  const BodyModel model = load_region(robot, plate.link, {0, 0, 0}, {2, 4, 6}, plate.pose);
  EXPECT_FALSE(why_malformed(model, robot));
  EXPECT_EQ(model.known, stacked_parameters(robot));
  ASSERT_EQ(model.shapes.size(), 1U);
  EXPECT_EQ(volume(model.shapes[0].shape), 48.0);
  // Middle (1, 2, 3) in the plate's frame: turned (-2, 1, 3), moved (-1, 3, 6).
  EXPECT_LT(scaled_difference(unit_parameters(model.shapes[0].shape).first_moment(),
                              Eigen::Vector3d(-1, 3, 6), 3),
            few_hundred_eps);
  EXPECT_THROW(static_cast<void>(load_region(robot, 0, {0, 0, 0}, {1, 0, 1})), InputError);
}

}  // namespace
}  // namespace shapeid
