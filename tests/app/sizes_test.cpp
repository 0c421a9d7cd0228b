// Robots of other sizes through the command: no joint, one joint, chains and trees of sixty.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/QR>

#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

using nlohmann::json;

// What lambda, 1e-12 of the squared torques, may leave of them.
constexpr double left_by_density_term = 1e-6;

/// Each link a box of uniform density, so that one shape of the right mass is the whole truth.
std::string link_text(int i) {
  const double mass = 0.5 + 0.1 * (i % 7), x = 0.06, y = 0.04 + 0.001 * (i % 5), z = 0.09;
  const double along_x = mass * (y * y + z * z) / 12.0, along_y = mass * (x * x + z * z) / 12.0,
               along_z = mass * (x * x + y * y) / 12.0;
  const char* origin = R"(<origin xyz="0.02 -0.01 0.04"/>)";
  return fmt::format(
      R"(<link name="l{}"><inertial>{}<mass value="{}"/><inertia ixx="{}" iyy="{}" izz="{}" ixy="0"
 ixz="0" iyz="0"/></inertial><collision>{}<geometry><box size="{} {} {}"/></geometry></collision></link>)",
      i, origin, mass, along_x, along_y, along_z, origin, x, y, z);
}

/// Links l0, ..., l<joints>; `parent` says where each hangs.
template <class Parent>
std::string urdf(int joints, Parent parent) {
  constexpr std::array<const char*, 3> axes = {"1 0 0", "0 1 0", "0 0.6 0.8"};
  std::string text = R"(<robot name="sized">)" + link_text(0);
  for (int i = 1; i <= joints; ++i) {
    text += link_text(i);
    text += fmt::format(
        R"(<joint name="j{0}" type="continuous"><parent link="l{1}"/><child link="l{0}"/>
<origin xyz="0.01 0 0.05"/><axis xyz="{2}"/></joint>)",
        i, parent(i), axes.at(static_cast<std::size_t>(i % 3)));
  }
  return text + "</robot>";
}

struct Column {
  std::string name;
  double value;
};

/// What an arm on a fixed base would log, from some time (s) of its motion on.
void write_log(const std::string& path, const Robot& robot, double begins) {
  std::unique_ptr<LogWriter> out;
  for (int k = 0; k < 3000; ++k) {
    const double t = begins + 0.002 * k;
    Sample s;
    s.time = t;
    const Eigen::Index n = robot.joint_count();
    s.q.resize(n);
    s.dq.resize(n);
    s.ddq.resize(n);
    s.tau.setZero(n);  // is what is sought
    for (Eigen::Index j = 0; j < n; ++j) {
      const double w = 3.0 + 0.37 * static_cast<double>(j % 11), a = 0.5;
      s.q[j] = a * std::sin(w * t + static_cast<double>(j));
      s.dq[j] = a * w * std::cos(w * t + static_cast<double>(j));
      s.ddq[j] = -w * w * s.q[j];
    }
    const Eigen::VectorXd force = reference::regressor(robot, s) * stacked_parameters(robot);
    std::vector<Column> row = {{"time", t}};
    for (Eigen::Index j = 0; j < n; ++j) {
      const std::string name = robot.joint(static_cast<int>(j)).name;
      row.push_back({"q." + name, s.q[j]});
      row.push_back({"dq." + name, s.dq[j]});
      row.push_back({"ddq." + name, s.ddq[j]});
      row.push_back({"tau." + name, force[j]});
    }
    if (!out) {
      std::vector<std::string> names;
      names.reserve(row.size());
      for (const Column& column : row) names.push_back(column.name);
      out = std::make_unique<LogWriter>(path, names);
    }
    std::vector<double> values;
    values.reserve(row.size());
    for (const Column& column : row) values.push_back(column.value);
    out->write(values);
  }
  out->close();
}

json identified(const std::string& name, const std::string& text, const std::string& options) {
  const std::string robot_file = scratch_file(name + ".urdf", text);
  UrdfOptions as;
  as.root = Root::fixed;
  const Robot robot = read_urdf(robot_file, as).robot;
  write_log(scratch() + "/" + name + ".csv", robot, 0.0);
  write_log(scratch() + "/" + name + "_later.csv", robot, 7.001);
  const CommandRun run =
      shapeid(fmt::format("identify --robot {0}.urdf --log {0}.csv --test {0}_later.csv --exact "
                          "--json --divisions 2 {1}",
                          name, options));
  EXPECT_EQ(run.status, 0) << name << ": " << run.err;
  return run.status == 0 ? json::parse(run.out) : json();
}

void expect_explained(const json& result) {
  ASSERT_FALSE(result.is_null());
  const auto zero = result.at("heldout").at("rms_zero").get<std::vector<double>>();
  const auto after = result.at("heldout").at("rms_after").get<std::vector<double>>();
  const double size = Eigen::Map<const Eigen::VectorXd>(zero.data(), std::ssize(zero)).norm();
  const double left = Eigen::Map<const Eigen::VectorXd>(after.data(), std::ssize(after)).norm();
  EXPECT_GT(size, 0.1);
  EXPECT_LT(left, left_by_density_term * size);
}

/// One body that three feet push about, each force measured: what a plate on three load cells logs.
std::string write_plate_log(const std::string& name, const Robot& robot) {
  LogWriter out(
      scratch() + "/" + name + ".csv",
      {"time",           "base.gyro.x",    "base.gyro.y",  "base.gyro.z",  "base.gyrodot.x",
       "base.gyrodot.y", "base.gyrodot.z", "base.accel.x", "base.accel.y", "base.accel.z",
       "force.f1.x",     "force.f1.y",     "force.f1.z",   "force.f2.x",   "force.f2.y",
       "force.f2.z",     "force.f3.x",     "force.f3.y",   "force.f3.z",   "contact.f1",
       "contact.f2",     "contact.f3"});
  const Eigen::Vector3d rates(7.0, 5.0, 6.1), sizes(0.8, 0.5, 0.6);
  for (int k = 0; k < 3000; ++k) {
    Sample s;
    s.time = 0.002 * k;
    for (int i = 0; i < 3; ++i) {
      s.base_angular_velocity[i] = sizes[i] * std::sin(rates[i] * s.time);
      s.base_angular_acceleration[i] = sizes[i] * rates[i] * std::cos(rates[i] * s.time);
      s.base_specific_force[i] += 2.0 * std::sin((rates[i] + 1.3) * s.time + i);
    }
    s.in_contact.assign(3, true);
    const Eigen::MatrixXd J = reference::contact_jacobian(robot, s);
    const Eigen::VectorXd wrench = reference::regressor(robot, s) * stacked_parameters(robot);
    const Eigen::VectorXd f = J.transpose().completeOrthogonalDecomposition().solve(wrench);
    std::vector<double> row = {s.time};
    for (const auto& v :
         {s.base_angular_velocity, s.base_angular_acceleration, s.base_specific_force}) {
      row.insert(row.end(), v.begin(), v.end());
    }
    row.insert(row.end(), f.begin(), f.end());
    row.insert(row.end(), 3, 1.0);
    out.write(row);
  }
  out.close();
  return name + ".csv";
}

TEST(Sizes, NoJoint) {
  std::string text = R"(<robot name="plate">)" + link_text(0);
  for (int i = 1; i <= 3; ++i) {
    text += fmt::format(
        R"(<link name="f{0}"/><joint name="j{0}" type="fixed"><parent link="l0"/><child link="f{0}"/>
<origin xyz="{1} {2} -0.05"/></joint>)",
        i, 0.1 * i - 0.2, 0.04 * i * i - 0.2);
  }
  const std::string file = scratch_file("plate.urdf", text + "</robot>");
  const std::string yaml =
      scratch_file("plate.robot.yaml", "contacts: [{link: f1}, {link: f2}, {link: f3}]\n");
  Robot robot = read_urdf(file).robot;
  static_cast<void>(read_robot_yaml(yaml, robot));
  const std::string log = write_plate_log("plate", robot);
  const CommandRun run =
      shapeid("identify --robot plate.urdf --contacts measured --exact --json --log " + log);
  ASSERT_EQ(run.status, 0) << run.err;
  const json link = json::parse(run.out).at("links").at(0);
  const auto Phi = link.at("parameters").get<std::vector<double>>();
  ASSERT_EQ(Phi.size(), 10U);
  const auto truth = stacked_parameters(robot);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(Phi[static_cast<std::size_t>(i)], truth[i], left_by_density_term * truth[0]) << i;
  }
}

/// Standard errors do not say how wrong the inertias of other links may be.
bool says_that_links_are_given(const json& result) {
  return result.at("notes").dump().find("what is taken as given (other links") != std::string::npos;
}

TEST(Sizes, OneJoint) {
  const json result = identified("one", urdf(1, [](int) { return 0; }), "--whole-body");
  expect_explained(result);
  EXPECT_FALSE(says_that_links_are_given(result));
}

TEST(Sizes, AChainOfSixty) {
  const json result =
      identified("chain", urdf(60, [](int i) { return i - 1; }), "--free l1 l17 l59 l60");
  expect_explained(result);
  EXPECT_TRUE(says_that_links_are_given(result));
}

TEST(Sizes, ATreeOfSixty) {
  expect_explained(
      identified("tree", urdf(60, [](int i) { return (i - 1) / 2; }), "--free l1 l2 l31 l60"));
}

}  // namespace
}  // namespace shapeid::test
