// The bundled robot is what its comments say.
#include "shapeid/tests/simulation/quadruped.hpp"

#include <gtest/gtest.h>

#include <array>

#include "shapeid/models/shape.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

Shape shape_of(const CollisionBody& body) {
  if (const auto* box = std::get_if<Box>(&body.geometry)) return make_cuboid(box->size, body.pose);
  const auto& cylinder = std::get<CylinderGeometry>(body.geometry);
  return make_cylinder(cylinder.radius, cylinder.length, body.pose);
}

// The masses stand as comments beside the collision bodies in the file.
TEST(Quadruped, BaseInertiaIsTheSumOfItsElevenBodies) {
  constexpr std::array masses = {0.56, 0.54, 0.57, 0.55, 1.05, 0.4, 0.36, 0.34, 0.42, 0.24, 0.45};
  const Link base = test::quadruped().links[0];
  ASSERT_EQ(base.collision.size(), masses.size());
  InertialParameters sum;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    sum = sum + masses[i] * unit_parameters(shape_of(base.collision[i]));
  }
  EXPECT_LT(scaled_difference(base.inertia.values, sum.values, 10), few_hundred_eps);
}

TEST(Quadruped, HasTwelveJointsEighteenDegreesOfFreedomAndThirteenKilograms) {
  const Robot robot = test::quadruped();
  EXPECT_EQ(robot.joint_count(), 12);
  EXPECT_EQ(robot.dof(), 18);
  EXPECT_EQ(robot.contacts.size(), 4u);
  double mass = 0.0;
  for (const Link& link : robot.links) mass += link.inertia.mass();
  EXPECT_LT(test::scaled(std::abs(mass - 13.0), 13.0, 13), few_hundred_eps);
}

TEST(Quadruped, NothingInItIsSuspicious) {
  const UrdfFile file = read_urdf(test::robots + "quadruped.urdf");
  for (const InertiaFinding& finding : file.findings) {
    ADD_FAILURE() << finding.link << ": " << finding.wrong;
  }
}

/// Mirrored through the plane between left and right: y becomes -y.
InertialParameters mirrored(const InertialParameters& body) {
  const Eigen::Matrix4d mirror = Eigen::Vector4d(1, -1, 1, 1).asDiagonal();
  return from_pseudo_inertia(mirror * pseudo_inertia(body) * mirror);
}

TEST(Quadruped, LeftLegsMirrorRightLegs) {
  const Robot robot = test::quadruped();
  for (const char* end : {"F", "R"}) {
    for (const char* part : {"_abad_link", "_thigh", "_shank"}) {
      const int right = robot.find_link(std::string(end) + "R" + part).value();
      const int left = robot.find_link(std::string(end) + "L" + part).value();
      const auto& body = robot.links[static_cast<std::size_t>(right)].inertia;
      const auto& other = robot.links[static_cast<std::size_t>(left)].inertia;
      EXPECT_LT(scaled_difference(mirrored(body).values, other.values, 10), few_hundred_eps);
      EXPECT_GT(scaled_difference(body.values, other.values, 10), 1e6) << "no side at all";
    }
  }
}

TEST(Quadruped, NotesNameFourFeetAtTheTipsOfTheShanks) {
  Robot robot = read_urdf(test::robots + "quadruped.urdf").robot;
  const RobotNotes notes = read_robot_yaml(test::robots + "quadruped.robot.yaml", robot);
  ASSERT_EQ(robot.contacts.size(), 4u);
  for (const Contact& contact : robot.contacts) {
    EXPECT_EQ(contact.kind, ContactKind::point);
    EXPECT_EQ(contact.frame.translation().z(), -0.2) << contact.name;
  }
  EXPECT_FALSE(notes.imu.translation().isZero());
}

// The shapes that are sought are the collision bodies, in their order.
TEST(Quadruped, ShapesAreItsElevenBodies) {
  const Robot robot = test::quadruped();
  const BodyModel model = read_shapes_yaml(test::robots + "quadruped.shapes.yaml", robot);
  ASSERT_EQ(model.free_links, std::vector<int>{0});
  const std::vector<CollisionBody>& bodies = robot.links[0].collision;
  ASSERT_EQ(model.shapes.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    EXPECT_EQ(unit_parameters(model.shapes[i].shape).values,
              unit_parameters(shape_of(bodies[i])).values);
  }
}

TEST(Quadruped, FiftyFourPointsFillTheBoxAroundTheBase) {
  const Robot robot = test::quadruped();
  const BodyModel model = read_shapes_yaml(test::robots + "quadruped.points.yaml", robot);
  EXPECT_EQ(model.shapes.size(), 54u);
  Eigen::AlignedBox3d box;
  for (const CollisionBody& body : robot.links[0].collision) {
    const auto [lower, upper] = bounds(shape_of(body));
    box.extend(lower).extend(upper);
  }
  for (const SoughtShape& sought : model.shapes) {
    EXPECT_TRUE(box.contains(std::get<Point>(sought.shape).position));
  }
}

}  // namespace
}  // namespace shapeid
