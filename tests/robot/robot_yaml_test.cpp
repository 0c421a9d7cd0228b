#include "shapeid/models/robot_yaml.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/robot/two_link_robot.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

TEST(RobotYaml, EverythingIsRead) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("robot.yaml", R"(
imu: {xyz: [0.1, -0.2, 0.3], rpy: [0, 0, 1.5707963267948966]}
contacts:
  - {link: leg, point: [0, 0, -0.5]}
  - {link: plate, kind: line, point: [0.5, 0, 0], axis: [2, 0, 0]}
  - {link: plate, kind: plane}
noise: {tau: 0.2, tau.knee: 0.5, base.gyro: 0.01, base.accel.z: 0.3, force.leg.x: 2}
rotors: {knee: {inertia: 6.3e-5, gear: 9.33}}
expected_mass: {plate: [1, 4], load: [0, 10]}
)");
  Robot robot = test::two_link_robot();
  const RobotNotes notes = read_robot_yaml(path, robot);

  EXPECT_EQ(notes.imu.translation(), Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_LT(
      scaled_difference(notes.imu.linear() * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 3),
      few_hundred_eps);

  ASSERT_EQ(robot.contacts.size(), 3U);
  EXPECT_EQ(robot.contacts[0].name, "leg");
  EXPECT_EQ(robot.contacts[0].link, 1);
  EXPECT_EQ(robot.contacts[0].kind, ContactKind::point);
  EXPECT_EQ(robot.contacts[0].frame.translation(), Eigen::Vector3d(0, 0, -0.5));
  // The plate's x axis is the trunk's y axis: point (1, 2, 3) + 0.5 y, line along y.
  EXPECT_EQ(robot.contacts[1].name, "plate");
  EXPECT_EQ(robot.contacts[1].link, 0);
  EXPECT_EQ(robot.contacts[1].kind, ContactKind::line);
  EXPECT_LT(scaled_difference(robot.contacts[1].frame.translation(), Eigen::Vector3d(1, 2.5, 3), 3),
            few_hundred_eps);
  EXPECT_LT(scaled_difference(robot.contacts[1].frame.linear() * Eigen::Vector3d::UnitX(),
                              Eigen::Vector3d::UnitY(), 3),
            few_hundred_eps);
  EXPECT_EQ(robot.contacts[2].kind, ContactKind::plane);

  EXPECT_EQ(notes.noise_sigma.size(), 5U);
  EXPECT_EQ(notes.noise_sigma.at("tau.knee"), 0.5);
  const auto knee = static_cast<std::size_t>(robot.find_joint("knee").value());
  EXPECT_DOUBLE_EQ(robot.links[knee + 1].joint.rotor_inertia, 6.3e-5 * 9.33 * 9.33);
  // The plate is part of the trunk, and it is the trunk that is identified.
  EXPECT_EQ(notes.expected_mass.at("trunk").lower, 1.0);
  EXPECT_EQ(notes.expected_mass.at("trunk").upper, 4.0);
  EXPECT_EQ(notes.expected_mass.at("load").upper, 10.0);
}

TEST(RobotYaml, NoiseMayBeGivenForEachComponentOfAVector) {
  const test::ScratchFolder folder;
  const auto takes = [&](const std::string& channel) {
    const std::string path = folder.write("robot.yaml", "noise: {" + channel + ": 1}");
    Robot robot = test::two_link_robot();
    try {
      return read_robot_yaml(path, robot).noise_sigma.contains(channel);
    } catch (const InputError&) {
      return false;
    }
  };
  for (const char* vector : {"base.gyro.", "base.accel.", "force.leg."}) {
    for (const char* component : {"x", "y", "z"})
      EXPECT_TRUE(takes(vector + std::string(component)));
    for (const char* component : {"w", "a", "", "xy"}) {
      EXPECT_FALSE(takes(vector + std::string(component)));
    }
  }
  for (const char* component : {"w", "x", "y", "z"}) {
    EXPECT_TRUE(takes(std::string("base.quat.") + component));
  }
  for (const char* component : {"v", "a"})
    EXPECT_FALSE(takes(std::string("base.quat.") + component));
}

// Every direction is a rotation's x axis, also the one opposite to x.
TEST(RobotYaml, LineContactPointsAlongItsAxis) {
  const test::ScratchFolder folder;
  for (const auto& [text, axis] : std::vector<std::pair<std::string, Eigen::Vector3d>>{
           {"[-1, 0, 0]", {-1, 0, 0}}, {"[0, 0, 3]", {0, 0, 1}}, {"[0, -4, 3]", {0, -0.8, 0.6}}}) {
    const std::string path =
        folder.write("robot.yaml", "contacts: [{link: leg, kind: line, axis: " + text + "}]\n");
    Robot robot = test::two_link_robot();
    static_cast<void>(read_robot_yaml(path, robot));
    const Eigen::Matrix3d R = robot.contacts.at(0).frame.linear();
    EXPECT_LT(scaled_difference(R.col(0), axis, 3), few_hundred_eps) << text;
    EXPECT_LT(scaled_difference(R * R.transpose(), Eigen::Matrix3d::Identity(), 3),
              few_hundred_eps);
    EXPECT_GT(R.determinant(), 0.0);
  }
}

TEST(RobotYaml, WithoutContactsThoseOfTheRobotStay) {
  const test::ScratchFolder folder;
  Robot robot = test::two_link_robot();
  robot.contacts.push_back({"leg", 1, ContactKind::point, Eigen::Isometry3d::Identity()});
  static_cast<void>(read_robot_yaml(folder.write("robot.yaml", "imu: {}\n"), robot));
  EXPECT_EQ(robot.contacts.size(), 1U);
  static_cast<void>(read_robot_yaml(folder.write("robot.yaml", "contacts: []\n"), robot));
  EXPECT_TRUE(robot.contacts.empty());
}

struct BrokenYaml {
  const char* text;
  const char* message;
};

TEST(RobotYaml, RefusalsSayLineWrongAndRight) {
  const std::vector<BrokenYaml> cases = {
      {"", ": robot.yaml is not a map; write lines of key: value"},
      {"- a list\n", ":1: robot.yaml is not a map; write lines of key: value"},
      {"imu: [1\n", ":2: not YAML: end of sequence flow not found; write YAML"},
      {"legs: 4\n",
       ":1: robot.yaml has no key legs; it has imu, contacts, noise, rotors, expected_mass"},
      {"imu: {}\nimu: {}\n", ":2: imu is named twice in robot.yaml; name it once"},
      {"imu: {xyz: [1, 2]}\n",
       ":1: imu xyz is not a list of 3 numbers; write them in brackets, with commas between them"},
      {"imu: {xyz: [1, 2, nan]}\n",
       ":1: imu xyz is not a finite number (\"nan\"); write a finite decimal number"},
      {"imu: {rpy: [0, 0, 90deg]}\n",
       ":1: imu rpy is not a number (\"90deg\"); write a finite decimal number"},
      {"imu: {rpy: [0, 0, 90]}\n", ":1: imu rpy turns by 90; radians, a turn at most"},
      {"imu: {position: [1, 2, 3]}\n", ":1: imu has no key position; it has xyz, rpy"},
      {"contacts: leg\n", ":1: contacts is not a list; write - {link: NAME}"},
      {"contacts:\n  - leg\n", ":2: a contact is not a map; write lines of key: value"},
      {"contacts:\n  - {point: [0, 0, 0]}\n",
       ":2: a contact does not give its link; it needs link"},
      {"contacts:\n  - {link: foot}\n", ":2: hopper has no link foot; name a link"},
      {"contacts:\n  - {link: leg, kind: sphere}\n",
       ":2: there is no contact of kind sphere; point, line or plane"},
      {"contacts:\n  - {link: leg, kind: line}\n",
       ":2: the line contact of leg does not say which line; write axis: [x, y, z], the direction "
       "about which no moment acts"},
      {"contacts:\n  - {link: leg, axis: [1, 0, 0]}\n",
       ":2: the contact of leg is no line; an axis belongs to kind: line"},
      {"contacts:\n  - {link: leg, kind: line, axis: [0, 1e200, 0]}\n",
       ":2: the axis is 1e+200 long; write a unit vector"},
      {"contacts:\n  - {link: leg, kind: line, axis: [0, 0, 0]}\n",
       ":2: the axis is zero; write a direction"},
      {"contacts:\n  - {link: leg}\n  - {link: leg, point: [0, 0, 0, 0]}\n",
       ":3: point is not a list of 3 numbers; write them in brackets, with commas between them"},
      {"contacts:\n  - {link: leg, point: [0, -2e6, 1]}\n",
       ":2: point is 2e+06 m away; metres, on the robot"},
      {"contacts:\n  - {link: leg, point: [0, 0, -200]}\n",
       ":2: point is 200 m from the link's origin, on a robot of 3.7 m; metres, on the robot"},
      {"contacts:\n  - {link: leg}\n  - {link: plate}\n  - {link: leg}\n",
       ":4: leg has a contact at this place already; name a contact once, or its other points"},
      {"contacts:\n  - {link: plate}\n  - {link: plate, kind: plane, point: [0, 0, 0]}\n",
       ":3: plate has a contact at this place already; name a contact once, or its other points"},
      {"imu: {xyz: [120, 0, 0]}\n",
       ":1: imu xyz is 120 m from the link's origin, on a robot of 3.7 m; metres, on the robot"},
      {"noise: {tau.ankle: 1}\n",
       ":1: tau.ankle is no channel of a log of hopper; write q, dq, ddq or tau, alone or with "
       ".<joint>, base.gyro, base.accel or base.quat, alone or with .x, force.<link>.x, base.force "
       "or "
       "base.moment"},
      {"noise:\n  tau: 1\n  base.gyro.w: 1\n",
       ":3: base.gyro.w is no channel of a log of hopper; write q, dq, ddq or tau, alone or with "
       ".<joint>, base.gyro, base.accel or base.quat, alone or with .x, force.<link>.x, base.force "
       "or "
       "base.moment"},
      {"noise: {tau: 0}\n", ":1: the sigma of tau is 0; it must be above zero"},
      {"noise:\n  tau: 1,5\n",
       ":2: the sigma of tau is not a number (\"1,5\": decimals take a point, not a comma); write "
       "a finite decimal number"},
      {"noise: {force.knee.x: 1}\n",
       ":1: force.knee.x is no channel of a log of hopper; write q, dq, ddq or tau, alone or with "
       ".<joint>, base.gyro, base.accel or base.quat, alone or with .x, force.<link>.x, base.force "
       "or "
       "base.moment"},
      {"noise: {temperature: 1}\n",
       ":1: temperature is no channel of a log of hopper; write q, dq, ddq or tau, alone or with "
       ".<joint>, base.gyro, base.accel or base.quat, alone or with .x, force.<link>.x, base.force "
       "or "
       "base.moment"},
      {"rotors: {mount: {inertia: 1, gear: 1}}\n",
       ":1: hopper has no moving joint mount; name a joint"},
      {"rotors: {knee: {inertia: 1}}\n",
       ":1: the rotor of knee does not give its gear; it needs inertia, gear"},
      {"rotors: {knee: {inertia: -1, gear: 1}}\n", ":1: inertia is -1; it must be above zero"},
      {"rotors: {knee: {inertia: 1, gear: 1e4}}\n",
       ":1: the rotor of knee counts as 1e+08 kg m^2; its inertia before the gear, kg m^2, and the "
       "gear's ratio"},
      {"rotors: {knee: 3}\n", ":1: the rotor of knee is not a map; write lines of key: value"},
      {"expected_mass: {leg: 3}\n",
       ":1: the mass of leg is not a list of 2 numbers; write them in brackets, with commas "
       "between them"},
      {"expected_mass: {leg: [3, 2]}\n",
       ":1: the mass of leg lies from 3 to 2; write [lower, upper] in kg, 0 <= lower < upper, "
       "upper from 1e-6 to 1e6"},
      {"expected_mass: {leg: [-1, 2]}\n",
       ":1: the mass of leg lies from -1 to 2; write [lower, upper] in kg, 0 <= lower < upper, "
       "upper from 1e-6 to 1e6"},
      {"expected_mass: {leg: [0, 1e-170]}\n",
       ":1: the mass of leg lies from 0 to 1e-170; write [lower, upper] in kg, 0 <= lower < upper, "
       "upper from 1e-6 to 1e6"},
      {"expected_mass: {hip: [1, 2]}\n", ":1: hopper has no link hip; name a link"},
      {"expected_mass:\n  trunk: [1, 2]\n  plate: [1, 2]\n",
       ":3: plate is one rigid body with a link named before; give the mass of the whole once"},
  };
  const test::ScratchFolder folder;
  for (const BrokenYaml& broken : cases) {
    Robot robot = test::two_link_robot();
    const std::string path = folder.write("robot.yaml", broken.text);
    try {
      static_cast<void>(read_robot_yaml(path, robot));
      ADD_FAILURE() << "accepted: " << broken.text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).substr(path.size()), broken.message) << broken.text;
    }
    EXPECT_TRUE(robot.contacts.empty()) << "a refused file changed the robot";
  }
}

}  // namespace
}  // namespace shapeid
