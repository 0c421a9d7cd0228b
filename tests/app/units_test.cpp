// Joints that slide have forces in N and places in m, in what is printed and in what is written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "shapeid/models/robot.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

TEST(Units, OfAJointThatTurnsAndOfOneThatSlides) {
  Joint joint;
  for (const JointKind kind : {JointKind::revolute, JointKind::continuous}) {
    joint.kind = kind;
    for (const char* unit : {"N m", "N m s/rad", "rad", "kg m^2", "", "1"}) {
      EXPECT_EQ(unit_at(joint, unit), unit);
    }
  }
  joint.kind = JointKind::prismatic;
  EXPECT_EQ(unit_at(joint, "N m"), "N");
  EXPECT_EQ(unit_at(joint, "N m s/rad"), "N s/m");
  EXPECT_EQ(unit_at(joint, "N m/rad"), "N/m");
  EXPECT_EQ(unit_at(joint, "rad/s^2"), "m/s^2");
  EXPECT_EQ(unit_at(joint, "1/rad"), "1/m");
  EXPECT_EQ(unit_at(joint, "kg m^2"), "kg");
  EXPECT_EQ(unit_at(joint, "s"), "s");
}

/// A weight of 3 kg that is lifted, and an arm of 2 kg that swings 0.4 m from its joint, side by
/// side on a post; with friction of 5 N s/m where it slides.
void lift_and_arm() {
  const auto link = [](const char* name, double mass, double x) {
    return fmt::format(
        "<link name='{}'><inertial><origin xyz='{} 0 0'/><mass value='{}'/><inertia ixx='0.01' "
        "iyy='0.02' izz='0.02' ixy='0' ixz='0' iyz='0'/></inertial></link>\n",
        name, x, mass);
  };
  const auto joint = [](const char* name, const char* kind, const char* child, const char* axis) {
    return fmt::format(
        "<joint name='{}' type='{}'><parent link='post'/><child link='{}'/><axis xyz='{}'/>"
        "<limit lower='-9' upper='9' effort='999' velocity='99'/></joint>\n",
        name, kind, child, axis);
  };
  scratch_file("post.urdf", "<robot name='post'>\n<link name='post'/>\n" + link("weight", 3, 0) +
                                link("arm", 2, 0.4) +
                                joint("lift", "prismatic", "weight", "0 0 1") +
                                joint("swing", "revolute", "arm", "0 -1 0") + "</robot>\n");
  std::string log = "time,q.lift,q.swing,dq.lift,dq.swing,ddq.lift,ddq.swing,tau.lift,tau.swing\n";
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.01 * i, u = 3.1 * t + std::sin(0.37 * t);
    const double du = 3.1 + 0.37 * std::cos(0.37 * t), ddu = -0.37 * 0.37 * std::sin(0.37 * t);
    const double q = std::sin(u), dq = du * std::cos(u), ddq = ddu * std::cos(u) - du * du * q;
    constexpr double g = 9.81, inertia = 0.02 + 2 * 0.4 * 0.4;
    log +=
        fmt::format("{},{},{},{},{},{},{},{},{}\n", t, 0.2 * q, q, 0.2 * dq, dq, 0.2 * ddq, ddq,
                    3 * (0.2 * ddq + g) + 5 * 0.2 * dq, inertia * ddq + 2 * g * 0.4 * std::cos(q));
  }
  scratch_file("post.csv", log);
}

TEST(Units, OfRobotsWithJointsOfBothKinds) {
  lift_and_arm();
  scratch_file("post.shapes.yaml",
               "weight: [{kind: cuboid, size: [0.2, 0.2, 0.2]}]\n"
               "arm: [{kind: cuboid, size: [0.8, 0.1, 0.1], pose: {xyz: [0.4, 0, 0]}}]\n");
  const CommandRun found =
      shapeid("identify --robot post.urdf --log post.csv --exact --shapes post.shapes.yaml");
  ASSERT_EQ(found.status, 0) << found.err;
  const auto line = [&](const std::string& name) {
    const std::size_t at = found.out.find("\n  " + name);
    return at == std::string::npos ? ""
                                   : found.out.substr(at + 1, found.out.find('\n', at + 1) - at);
  };
  EXPECT_TRUE(line("lift").ends_with("  N\n")) << found.out;
  EXPECT_TRUE(line("swing").ends_with("  N m\n")) << found.out;
  EXPECT_TRUE(line("all joints").ends_with("  N m and N\n")) << found.out;
}

TEST(Units, OfFrictionWhereAJointSlides) {
  lift_and_arm();
  const CommandRun found =
      shapeid("diagnose --robot post.urdf --log post.csv --exact --out post --json");
  ASSERT_EQ(found.status, 0) << found.err;
  EXPECT_NE(found.out.find("N s/m"), std::string::npos) << found.out;
  EXPECT_EQ(found.out.find("N m s/rad"), std::string::npos) << found.out;
  const std::string page = text_of(scratch() + "/post/report.html");
  EXPECT_NE(page.find("N s/m"), std::string::npos);
  EXPECT_NE(page.find("velocity (m/s)"), std::string::npos);
}

CommandRun identified_as(const std::string& cuboid) {
  scratch_file("sized.shapes.yaml", "arm: [{kind: cuboid, " + cuboid + "}]\n");
  return shapeid(
      "identify --robot post.urdf --log post.csv --exact --shapes sized.shapes.yaml "
      "--divisions 0");
}

/// The arm as the cuboid that has its moments about the joint, as one five times as large, and as
/// one whose millimetres were taken for metres: nothing near the arm's mass has its moments then.
TEST(Units, ShapesOfTheWrongSizeAreSaidByWhatTheyPredict) {
  lift_and_arm();
  for (const bool wrong : {false, true}) {
    const CommandRun run =
        identified_as(wrong ? "size: [1.581139, 0.707107, 0.707107], pose: {xyz: [2, 0, 0]}"
                            : "size: [0.3162278, 0.1414214, 0.1414214], pose: {xyz: [0.4, 0, 0]}");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out.find("predicted worse than by the given model") != std::string::npos, wrong)
        << run.out;
  }
  expect_one_line(identified_as("size: [316.2278, 141.4214, 141.4214], pose: {xyz: [400, 0, 0]}"),
                  1, "lengths of shapes or contacts are no metres");
}

}  // namespace
}  // namespace shapeid::test
