// Robots that are drawn: they can be, are of every sort, and the same wherever they are drawn.
#include "shapeid/tests/blind/parts/drawn.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "shapeid/models/error.hpp"
#include "shapeid/models/file_output.hpp"
#include "shapeid/models/simbody/leg.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/blind/parts/drawn_quadruped.hpp"
#include "shapeid/tests/blind/parts/trial.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::blind {
namespace {

constexpr std::uint64_t looked_at = 200;

TEST(DrawnArms, AreOfEverySort) {
  std::set<int> joints;
  std::set<double> rates, cutoffs;
  int sliders = 0, turning = 0, together = 0, oblique = 0;
  for (std::uint64_t seed = 0; seed < looked_at; ++seed) {
    const Machine m = drawn_arm(seed);
    joints.insert(m.robot.joint_count());
    rates.insert(m.rate);
    cutoffs.insert(m.cutoff);
    for (int j = 0; j < m.robot.joint_count(); ++j) {
      const Joint& joint = m.robot.joint(j);
      ++(joint.kind == JointKind::prismatic ? sliders : turning);
      if (joint.placement.translation().isZero()) ++together;
      if (joint.axis.cwiseAbs().maxCoeff() < 0.99) ++oblique;
    }
  }
  EXPECT_EQ(joints, (std::set<int>{2, 3, 4, 5, 6}));
  EXPECT_EQ(rates.size(), 3U);
  EXPECT_EQ(cutoffs.size(), 4U);
  EXPECT_GT(sliders, turning / 12);
  EXPECT_LT(sliders, turning / 4);
  EXPECT_GT(together, turning / 10);
  EXPECT_GT(oblique, turning / 10);
}

/// All of them sought by the diagnosis.
TEST(DrawnArms, AreMadeOfBodies) {
  for (std::uint64_t seed = 0; seed < looked_at; ++seed) {
    const Machine m = drawn_arm(seed);
    ASSERT_EQ(std::ssize(m.free_links), m.robot.joint_count());
    for (const int link : m.free_links) {
      const InertialParameters& body = m.robot.links[static_cast<std::size_t>(link)].inertia;
      SCOPED_TRACE(m.name);
      EXPECT_FALSE(why_impossible(body));
    }
  }
}

TEST(DrawnRobots, AreTheSameByTheirName) {
  const Machine one = drawn_arm(95200003), again = machine(one.name);
  EXPECT_EQ(one.urdf, again.urdf);
  EXPECT_EQ(one.yaml, again.yaml);
  EXPECT_EQ(one.rate, again.rate);
  EXPECT_NE(one.urdf, drawn_arm(95200004).urdf);
  EXPECT_EQ(machine("arm").urdf, arm().urdf);
  EXPECT_EQ(machine("quadruped").robot.root, Root::floating);
  for (const char* name :
       {"", "drawn", "drawn-1", "drawn7x", "drawn99999999999999999999", "crane", "trotter"}) {
    EXPECT_THROW((void)machine(name), InputError) << name;
  }
}

/// The diagnosis reads of a drawn arm what was drawn, but for the inertias.
TEST(DrawnArms, AreReadFromTheirFiles) {
  const test::ScratchFolder scratch;
  const Machine m = drawn_arm(12);
  Trial trial;
  trial.machine = m.name;
  write_logs(m, trial, simulate_clean(m, 1), scratch.path(""));
  Machine read;
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  read.robot = read_urdf(scratch.path("given.urdf"), fixed).robot;
  read.notes = read_robot_yaml(scratch.path("given.robot.yaml"), read.robot);
  EXPECT_EQ(read.notes.noise_sigma, m.notes.noise_sigma);
  ASSERT_EQ(read.robot.link_count(), m.robot.link_count());
  for (int j = 0; j < m.robot.joint_count(); ++j) {
    EXPECT_TRUE(read.robot.joint(j).placement.isApprox(m.robot.joint(j).placement, 0.0));
    EXPECT_EQ(read.robot.joint(j).axis, m.robot.joint(j).axis);
    const auto link = static_cast<std::size_t>(j) + 1;
    EXPECT_NE(read.robot.links[link].inertia.values, m.robot.links[link].inertia.values);
  }
  EXPECT_EQ(std::stod(read_small_file(scratch.path("cutoff"), 100)), m.cutoff);
}

/// Feet of the straight legs, in axes of the base; the base's own frame is the only one that all
/// drawings share.
std::vector<Eigen::Vector3d> straight_feet(const Robot& robot) {
  std::vector<Eigen::Vector3d> feet;
  for (const Contact& contact : robot.contacts) {
    feet.push_back(Leg(robot, contact).position(Eigen::Vector3d::Zero()));
  }
  return feet;
}

TEST(DrawnQuadrupeds, AreMirroredBodies) {
  int turned = 0, reversed = 0;
  for (std::uint64_t seed = 0; seed < looked_at; ++seed) {
    const Machine m = drawn_quadruped(seed);
    SCOPED_TRACE(m.name);
    ASSERT_EQ(m.robot.joint_count(), 12);
    for (const Link& link : m.robot.links) EXPECT_FALSE(why_impossible(link.inertia)) << link.name;
    const auto feet = straight_feet(m.robot);
    ASSERT_EQ(feet.size(), 4U);
    const Eigen::Vector3d across(1.0, -1.0, 1.0);
    constexpr double written = 3e-6;  // m, three joints to six places
    for (const std::size_t right : {0U, 2U}) {
      EXPECT_LT((feet[right] - across.cwiseProduct(feet[right + 1])).norm(), written);
      // Legs of one side are equal: what they weigh, and how far from the base's origin.
      EXPECT_NEAR(feet[right].y(), feet[0].y(), written);
    }
    EXPECT_GT(feet[0].x(), 0.0);
    EXPECT_LT(feet[2].x(), 0.0);
    EXPECT_LT(m.trot.height, -feet[0].z());
    for (const std::size_t own : {1U, 2U, 3U}) {
      const std::size_t other = own + 3;
      EXPECT_DOUBLE_EQ(m.robot.links[own].inertia.mass(), m.robot.links[other].inertia.mass());
    }
    if (m.robot.joint(1).placement.linear().trace() < 2.9) ++turned;
    if (m.robot.joint(1).axis.minCoeff() < -0.9) ++reversed;
  }
  EXPECT_GT(turned, static_cast<int>(looked_at) / 4);
  EXPECT_GT(reversed, static_cast<int>(looked_at) / 4);
}

TEST(DrawnQuadrupeds, AreReadFromTheirFiles) {
  const test::ScratchFolder scratch;
  const Machine m = machine("trotter12");
  write_file(scratch.path("given.urdf"), m.urdf);
  write_file(scratch.path("given.robot.yaml"), m.yaml);
  UrdfOptions floating;
  floating.root = Root::floating;
  Robot robot = read_urdf(scratch.path("given.urdf"), floating).robot;
  const RobotNotes notes = read_robot_yaml(scratch.path("given.robot.yaml"), robot);
  EXPECT_EQ(notes.noise_sigma, m.notes.noise_sigma);
  EXPECT_TRUE(notes.imu.isApprox(m.notes.imu, 0.0));
  ASSERT_EQ(robot.contacts.size(), m.robot.contacts.size());
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    EXPECT_EQ(robot.contacts[c].name, m.robot.contacts[c].name);
    EXPECT_EQ(robot.contacts[c].link, m.robot.contacts[c].link);
    EXPECT_TRUE(robot.contacts[c].frame.isApprox(m.robot.contacts[c].frame, 0.0));
  }
  EXPECT_EQ(stacked_parameters(robot), stacked_parameters(m.robot));
}

}  // namespace
}  // namespace shapeid::blind
