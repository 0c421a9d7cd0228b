// Arms that are drawn: robots that can be, of every sort, and the same wherever they are drawn.
#include "shapeid/tests/blind/parts/drawn.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf.hpp"
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

TEST(DrawnArms, AreTheSameByTheirName) {
  const Machine one = drawn_arm(95200003), again = machine(one.name);
  EXPECT_EQ(one.urdf, again.urdf);
  EXPECT_EQ(one.yaml, again.yaml);
  EXPECT_EQ(one.rate, again.rate);
  EXPECT_NE(one.urdf, drawn_arm(95200004).urdf);
  EXPECT_EQ(machine("arm").urdf, arm().urdf);
  EXPECT_EQ(machine("quadruped").robot.root, Root::floating);
  for (const char* name :
       {"", "drawn", "drawn-1", "drawn7x", "drawn99999999999999999999", "crane"}) {
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

}  // namespace
}  // namespace shapeid::blind
