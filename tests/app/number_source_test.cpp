// What a number of the answer is said to come from, where acceleration is mostly noise. An arm
// turns about two level axes; its inner link is sought, which gravity weighs in slow motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <tuple>

#include "shapeid/app/number_source.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

constexpr auto swung_arm = R"(<robot name="swung_arm">
  <link name="mount"/>
  <link name="inner">
    <inertial><origin xyz="0.2 0.01 0.02"/><mass value="2"/>
      <inertia ixx="0.003" ixy="0" ixz="0" iyy="0.028" iyz="0" izz="0.029"/></inertial>
    <collision><origin xyz="0.2 0 0"/><geometry><box size="0.44 0.1 0.08"/></geometry></collision>
  </link>
  <link name="outer">
    <inertial><origin xyz="0.1 0.02 0"/><mass value="0.5"/>
      <inertia ixx="0.0004" ixy="0" ixz="0" iyy="0.002" iyz="0" izz="0.0021"/></inertial>
  </link>
  <joint name="shoulder" type="continuous">
    <parent link="mount"/><child link="inner"/><axis xyz="0 1 0"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="inner"/><child link="outer"/><origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
  </joint>
</robot>
)";
constexpr double inner_Iyy = 0.028 + 2.0 * (0.2 * 0.2 + 0.02 * 0.02);
constexpr std::size_t Iyy = 7;

/// 24 s in which the shoulder turns by 1 rad, slowly, and by so many (`fast`) at 1.1 Hz; `noise` of
/// torque, N m. Encoders have 0.1 mrad of it: behind 20 Hz 0.2 rad/s^2 of acceleration, of which
/// the slow motion has 0.05; behind 10 Hz a thirtieth of that power.
void write_swung_log(const std::string& name, double fast, double noise) {
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  const Robot robot = parse_urdf(swung_arm, "swung_arm.urdf", fixed).robot;
  scratch_file("swung_arm.urdf", swung_arm);
  std::ofstream log(scratch() + "/" + name);
  log << "time,q.shoulder,q.elbow,tau.shoulder,tau.elbow\n";
  log.precision(12);
  Draw draw(5);
  Sample sample;
  sample.q.resize(2);
  sample.dq.resize(2);
  sample.ddq.resize(2);
  for (int i = 0; i < 12000; ++i) {
    sample.time = i / 500.0;
    sample.q.setZero();
    sample.dq.setZero();
    sample.ddq.setZero();
    for (const auto& [joint, size, hertz] :
         {std::tuple{0, 1.0, 0.04}, std::tuple{0, fast, 1.1}, std::tuple{1, 0.6, 0.7}}) {
      const double w = 2.0 * std::numbers::pi * hertz, phase = w * sample.time + 0.4;
      sample.q[joint] += size * std::sin(phase);
      sample.dq[joint] += size * w * std::cos(phase);
      sample.ddq[joint] -= size * w * w * std::sin(phase);
    }
    const Eigen::VectorXd tau = reference::regressor(robot, sample) * stacked_parameters(robot);
    log << sample.time;
    for (const double q : sample.q) log << ',' << q + 1e-4 * draw.normal();
    for (const double torque : tau) log << ',' << torque + noise * draw.normal();
    log << '\n';
  }
}

struct SwungAnswer {
  json document, inner;
  std::string text;
};

SwungAnswer swung_answer(const std::string& log, const std::string& options = "") {
  const CommandRun run = shapeid("identify --robot swung_arm.urdf --free inner --out swung --log " +
                                 log + " " + options);
  EXPECT_EQ(run.status, 0) << run.err;
  SwungAnswer result{json::parse(text_of(scratch() + "/swung/result.json")), {}, run.out};
  result.inner = result.document.at("links").at(0);
  return result;
}

double of_Iyy(const SwungAnswer& a, const char* key) {
  return a.inner.at(key).at(Iyy).get<double>();
}

TEST(NumberSource, SaysWhatASlowerFilterMakesOfNoise) {
  write_swung_log("little.csv", 0.01, 0.002);
  const SwungAnswer a = swung_answer("little.csv");
  const double said = of_Iyy(a, "data_value"), error = of_Iyy(a, "data_standard_error");
  ASSERT_GT(std::abs(said - inner_Iyy), 5.0 * error) << "the error does not know of it";
  EXPECT_EQ(a.document.at("slower_cutoff"), 10.0);
  const double slower = said + of_Iyy(a, "move_behind_slower_filter");
  EXPECT_LT(std::abs(slower - inner_Iyy), 0.25 * std::abs(said - inner_Iyy));
  EXPECT_EQ(a.inner.at("hangs_on_filter").at(Iyy), true);
  EXPECT_NE(a.text.find(fmt::format("; behind 10 Hz the data say {:.5g}\n", slower)),
            std::string::npos)
      << a.text;
  EXPECT_NE(a.text.find("note: of 1 number the data say something else behind a filter of 10 Hz"),
            std::string::npos)
      << a.text;

  // Rows behind 8 Hz are asked behind 4. Signals that end at 20 pass 30 as they are.
  EXPECT_EQ(swung_answer("little.csv", "--row-cutoff 8").document.at("slower_cutoff"), 4.0);
  const SwungAnswer faster = swung_answer("little.csv", "--row-cutoff 60");
  EXPECT_EQ(faster.document.at("slower_cutoff"), 10.0);
  EXPECT_EQ(faster.inner.at("hangs_on_filter").at(Iyy), true);
}

// What is judged is the load alone; with its link it may be a body's.
TEST(NumberSource, SaysThatItIsTheLoadThatNoBodyHas) {
  app::Result result;
  result.found.standard_error = Eigen::VectorXd::Zero(10);
  reference::Determination& data = result.found.data;
  data.value = Eigen::VectorXd::Constant(10, -0.5);
  data.standard_error = Eigen::VectorXd::Constant(10, 0.1);
  data.natural_size = Eigen::VectorXd::Ones(10);
  data.determined.assign(10, false);
  EXPECT_EQ(app::number_source_text(result, 0, 0.0), "shapes, the data impossible: -0.5");
  EXPECT_EQ(app::number_source_text(result, 0, 3.0),
            "shapes, the data impossible: -0.5 of what is sought");
  EXPECT_EQ(app::number_source_text(result, 1, 3.0), "shapes and bounds");
}

TEST(NumberSource, CallsNoRoundingNoise) {
  simulated_log("rounding.csv", "--exact");
  const CommandRun run = shapeid(fmt::format(
      "identify {} {} --exact --row-cutoff 20 --divisions 0 --log rounding.csv --out rounding",
      quadruped_files, quadruped_shapes));
  ASSERT_EQ(run.status, 0) << run.err;
  const json link = json::parse(text_of(scratch() + "/rounding/result.json")).at("links").at(0);
  double largest = 0.0;  // of moves, in errors
  for (std::size_t p = 0; p < 10; ++p) {
    const double error = link.at("data_standard_error").at(p);
    ASSERT_LT(error, 1e-13);
    largest = std::max(largest,
                       std::abs(link.at("move_behind_slower_filter").at(p).get<double>()) / error);
  }
  ASSERT_GT(largest, 3.0) << "rounding is within errors";
  EXPECT_EQ(link.at("hangs_on_filter"), json(std::vector<bool>(10, false)));
  EXPECT_EQ(run.out.find(" the data say"), std::string::npos) << run.out;
}

// A filter of 0.1 Hz settles in no stretch of this log: nothing is held out, no sample lost.
TEST(NumberSource, SaysThatTheFilterOfTheRowsLeavesNothing) {
  write_swung_log("short.csv", 0.7, 0.1);
  const CommandRun run = shapeid(
      "identify --robot swung_arm.urdf --free inner --log short.csv --row-cutoff 0.1 --out short");
  EXPECT_NE(run.status, 0);
  EXPECT_NE(run.err.find("no stretch between gaps is long enough for the filter of the rows"),
            std::string::npos)
      << run.err;
}

TEST(NumberSource, IsTheDataWhereTheMotionIsNoNoise) {
  write_swung_log("much.csv", 0.7, 0.1);
  const SwungAnswer a = swung_answer("much.csv");
  EXPECT_EQ(a.inner.at("determined").at(Iyy), true);
  EXPECT_EQ(a.inner.at("determined_by").at(Iyy), "data");
  EXPECT_EQ(a.inner.at("hangs_on_filter").at(Iyy), false);
  EXPECT_LT(std::abs(of_Iyy(a, "move_behind_slower_filter")),
            2.0 * of_Iyy(a, "data_standard_error"));
  EXPECT_EQ(a.text.find(" the data say"), std::string::npos) << a.text;
}

/// What the outer link's known inertia asks for by noise, the inner one would have to give back.
TEST(NumberSource, IsNotADataValueThatNoBodyHas) {
  write_swung_log("none.csv", 0.0, 0.002);
  const SwungAnswer a = swung_answer("none.csv");
  const double said = of_Iyy(a, "data_value");
  ASSERT_LT(said, -5.0 * of_Iyy(a, "data_standard_error"));
  EXPECT_EQ(a.inner.at("determined").at(Iyy), false);
  EXPECT_EQ(a.inner.at("determined_by").at(Iyy), "shapes, the data impossible");
  EXPECT_NE(a.text.find(fmt::format("shapes, the data impossible: {:.5g}", said)),
            std::string::npos)
      << a.text;
}

}  // namespace
}  // namespace shapeid::test
