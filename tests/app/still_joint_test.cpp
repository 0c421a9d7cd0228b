// A joint that never moves: friction holds any torque there, so that it has no error to be shown.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

/// Two arms of 2 kg on a post: one swings, the brake of the other holds it against 7 N m.
void swinging_and_braked() {
  std::string urdf = "<robot name='post'>\n<link name='post'/>\n";
  for (const char* name : {"swing", "braked"}) {
    urdf += fmt::format(
        "<link name='{0}_arm'><inertial><origin xyz='0.4 0 0'/><mass value='2'/><inertia "
        "ixx='0.01' "
        "iyy='0.02' izz='0.02' ixy='0' ixz='0' iyz='0'/></inertial></link>\n"
        "<joint name='{0}' type='revolute'><parent link='post'/><child link='{0}_arm'/>"
        "<axis xyz='0 -1 0'/><limit lower='-9' upper='9' effort='99' velocity='99'/></joint>\n",
        name);
  }
  scratch_file("still.urdf", urdf + "</robot>\n");
  std::string log = "time,q.swing,q.braked,dq.swing,dq.braked,tau.swing,tau.braked\n";
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.01 * i, u = 3.1 * t + std::sin(0.37 * t);
    const double du = 3.1 + 0.37 * std::cos(0.37 * t), ddu = -0.37 * 0.37 * std::sin(0.37 * t);
    const double q = std::sin(u), dq = du * std::cos(u), ddq = ddu * std::cos(u) - du * du * q;
    constexpr double inertia = 0.02 + 2 * 0.4 * 0.4, weight = 2 * 9.81 * 0.4;
    log += fmt::format("{},{},0.3,{},0,{},7\n", t, q, dq, inertia * ddq + weight * std::cos(q));
  }
  scratch_file("still.csv", log);
  scratch_file("still.yaml", "effects: []\n");
}

/// The row of the errors with this name.
std::string row(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n  " + name + " ");
  return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST(StillJoint, HasNoErrorBesideKnownEffects) {
  swinging_and_braked();
  const std::string command =
      "identify --robot still.urdf --log still.csv --cutoff 20 --effects still.yaml --free "
      "swing_arm";
  const CommandRun text = shapeid(command);
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(row(text.out, "braked"),
            fmt::format("  {:<20}{:>12}{:>12}{:>12}  N m", "braked", "-", "-", "-"))
      << text.out;
  EXPECT_EQ(row(text.out, "swing").find(" -"), std::string::npos) << text.out;
  EXPECT_EQ(row(text.out, "all joints").find("nan"), std::string::npos) << text.out;
  const CommandRun printed = shapeid(command + " --json");
  const auto heldout = nlohmann::json::parse(printed.out).at("heldout");
  for (const char* model : {"rms_zero", "rms_before", "rms_after"}) {
    EXPECT_TRUE(heldout.at(model).at(0).is_number()) << heldout;
    EXPECT_TRUE(heldout.at(model).at(1).is_null()) << heldout;
  }
}

const std::string post_files = "--robot still.urdf --log still.csv --cutoff 20 ";

/// Of an arm that swings about one axis no torque tells the mass: it is the given one, and how
/// little that lets it scatter is no error.
TEST(StillJoint, OfNumbersThatAreNotDeterminedNoErrorIsSaid) {
  std::size_t determined = 0, held = 0;
  swinging_and_braked();
  const auto result = diagnosed(post_files + "--free swing_arm braked_arm");
  for (const auto& link : result.at("links")) {
    for (std::size_t p = 0; p < 10; ++p) {
      const bool is_determined = link.at("determined").at(p).get<bool>();
      ++(is_determined ? determined : held);
      for (const char* error :
           {"standard_error", "error_if_unnoticed", "move_behind_slower_filter"}) {
        EXPECT_EQ(link.at(error).at(p).is_null(), !is_determined) << error << " " << p;
      }
      if (!is_determined) continue;
      const double move = link.at("move_behind_slower_filter").at(p).get<double>();
      EXPECT_GE(link.at("error_if_unnoticed").at(p).get<double>(), std::abs(move)) << p;
    }
  }
  EXPECT_GT(determined, 0U);
  EXPECT_GT(held, 0U);
  const auto unfiltered = diagnosed("--robot still.urdf --log still.csv --cutoff 0");
  for (const auto& link : unfiltered.at("links")) {
    EXPECT_TRUE(link.at("move_behind_slower_filter").is_null());
  }
}

/// Nothing of it can be drawn; gnuplot refuses a panel without points, and the whole report was
/// lost.
TEST(StillJoint, LosesNoReport) {
  swinging_and_braked();
  const CommandRun run = shapeid("diagnose " + post_files + "--free swing_arm --out still_report");
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string page = text_of(scratch() + "/still_report/report.html");
  EXPECT_NE(page.find("It stands still in the test"), std::string::npos);
  EXPECT_NE(page.find("swing, test motion: logged"), std::string::npos);
}

TEST(StillJoint, HasNoErrorInADiagnosis) {
  swinging_and_braked();
  const auto result = diagnosed(post_files);
  EXPECT_TRUE(result.at("heldout").at("rms_after").at(0).is_number());
  EXPECT_TRUE(result.at("heldout").at("rms_after").at(1).is_null());
}

}  // namespace
}  // namespace shapeid::test
