// A robot that moves in a plane feels nothing of cuts across it: divisions go on, or say so.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

/// A bar of 2 kg that swings about y, 0.1 m out and 0.03 m up from its joint; and a shape for it
/// that is far the longest along y.
void write_bar() {
  scratch_file("bar.urdf",
               "<robot name='bar'>\n<link name='post'/>\n<link name='bar'><inertial>"
               "<origin xyz='0.1 0 0.03'/><mass value='2'/><inertia ixx='0.01' iyy='0.01' "
               "izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial></link>\n"
               "<joint name='swing' type='continuous'><parent link='post'/><child link='bar'/>"
               "<axis xyz='0 -1 0'/></joint></robot>\n");
  scratch_file("bar.shapes.yaml",
               "bar: [{kind: cuboid, size: [0.4, 1.5, 0.3], pose: {xyz: [0.12, 0, 0.01]}}]\n");
  std::string log = "time,q.swing,dq.swing,ddq.swing,tau.swing\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.01 * i, u = 3.1 * t + std::sin(0.37 * t);
    const double du = 3.1 + 0.37 * std::cos(0.37 * t), ddu = -0.37 * 0.37 * std::sin(0.37 * t);
    const double q = std::sin(u), dq = du * std::cos(u), ddq = ddu * std::cos(u) - du * du * q;
    constexpr double g = 9.81, inertia = 0.01 + 2 * (0.1 * 0.1 + 0.03 * 0.03);
    log += fmt::format("{},{},{},{},{}\n", t, q, dq, ddq,
                       inertia * ddq + 2 * g * (0.1 * std::cos(q) - 0.03 * std::sin(q)));
  }
  scratch_file("bar.csv", log);
}

CommandRun identified(const std::string& options) {
  return shapeid("identify --robot bar.urdf --log bar.csv --exact --shapes bar.shapes.yaml " +
                 options);
}

TEST(PlateauOfDivisions, IsNoEndByDefault) {
  write_bar();
  const CommandRun run = identified("--json");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  EXPECT_EQ(result["stopped_by"], "step");
  EXPECT_LT(result["heldout"]["rms_after"][0].get<double>(),
            1e-3 * result["heldout"]["rms_zero"][0].get<double>());
  EXPECT_EQ(run.out.find("predicted worse"), std::string::npos);
  EXPECT_EQ(run.out.find("above the floor"), std::string::npos);
}

TEST(PlateauOfDivisions, IsWhatTheNoteSpeaksOfWhereTheyEndOnIt) {
  write_bar();
  const CommandRun run = identified("--divisions 3");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("shapes may be too coarse; divisions ended (limit)"), std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("--eps 0"), std::string::npos);
  EXPECT_EQ(run.out.find("units"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace shapeid::test
