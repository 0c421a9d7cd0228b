#include "shapeid/fuzz/support/robots.hpp"

#include <fmt/format.h>

#include <cmath>

#include "shapeid/models/urdf.hpp"

namespace shapeid::fuzz {
namespace {

/// Sigma = L L^T, so that the body can exist; its smallest extent is a thousandth of a metre.
InertialParameters any_body(Bytes& bytes) {
  constexpr double thinnest = 1e-3;
  PseudoInertia L = PseudoInertia::Zero();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < row; ++column) L(row, column) = 0.3 * bytes.unit();
    L(row, row) = thinnest + 0.3 * std::abs(bytes.unit());
  }
  L.row(3).head<3>() = 0.5 * bytes.units(3).transpose();
  L(3, 3) = 0.1 + std::abs(bytes.unit());
  const double mass = std::pow(10.0, 2.0 * bytes.unit());
  return from_pseudo_inertia(mass * L * L.transpose());
}

Joint any_joint(Bytes& bytes, int number) {
  Joint joint;
  joint.name = fmt::format("j{}", number);
  joint.kind = static_cast<JointKind>(bytes.count(0, 2));
  joint.axis = bytes.direction();
  joint.placement.linear() = bytes.rotation();
  joint.placement.translation() = bytes.vector(0.5);
  return joint;
}

}  // namespace

Robot hopper() {
  Robot robot = parse_urdf(R"(<robot name="hopper">
  <link name="trunk"><inertial><origin xyz="0.1 0 0.02"/><mass value="3"/>
    <inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0.002" izz="0.04"/></inertial></link>
  <link name="plate"/>
  <link name="leg"><inertial><origin xyz="0 0.01 -0.2"/><mass value="1"/>
    <inertia ixx="0.0125" ixy="0" ixz="0" iyy="0.0105" iyz="0" izz="0.00375"/></inertial></link>
  <joint name="mount" type="fixed"><origin xyz="0.1 0.2 0.3" rpy="0 0 1.57"/>
    <parent link="trunk"/><child link="plate"/></joint>
  <joint name="knee" type="revolute"><parent link="trunk"/><child link="leg"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="9" velocity="9"/></joint>
</robot>)",
                           "hopper.urdf")
                    .robot;
  Contact foot;
  foot.name = "leg";
  foot.link = 1;
  foot.frame.translation() = Eigen::Vector3d(0.0, 0.0, -0.4);
  robot.contacts = {foot};
  return robot;
}

Robot any_robot(Bytes& bytes) {
  Robot robot;
  robot.root = bytes.flag() ? Root::floating : Root::fixed;
  const int links = bytes.count(robot.root == Root::fixed ? 2 : 1, 8);
  for (int i = 0; i < links; ++i) {
    Link link;
    link.name = fmt::format("l{}", i);
    link.parent = i == 0 ? -1 : bytes.count(0, i - 1);
    if (i > 0) link.joint = any_joint(bytes, i - 1);
    link.inertia = any_body(bytes);
    robot.links.push_back(link);
  }
  return robot;
}

Sample any_sample(Bytes& bytes, const Robot& robot) {
  Sample sample;
  if (robot.root == Root::floating) {
    sample.base_angular_velocity = bytes.vector(10.0);
    sample.base_angular_acceleration = bytes.vector(100.0);
    sample.base_specific_force = bytes.vector(50.0);
  }
  const int n = robot.joint_count();
  sample.q = 3.0 * bytes.units(n);
  sample.dq = 20.0 * bytes.units(n);
  sample.ddq = 200.0 * bytes.units(n);
  sample.tau = Eigen::VectorXd::Zero(n);
  return sample;
}

}  // namespace shapeid::fuzz
