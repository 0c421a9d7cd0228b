#include "shapeid/tests/vectors/make/robots.hpp"

#include <fmt/format.h>

#include <cmath>

#include "shapeid/models/strict_json.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {
namespace {

using nlohmann::json;

json pose_json(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d R = pose.linear();
  const Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), std::asin(-R(2, 0)),
                            std::atan2(R(1, 0), R(0, 0)));
  return {{"xyz", vector_json(pose.translation())}, {"rpy", vector_json(rpy)}};
}

/// The pose that its written angles say, so that robot and text agree to the last bit.
Eigen::Isometry3d drawn_pose(test::Draw& draw) {
  const Eigen::Vector3d xyz = draw.vector(0.3), rpy = draw.vector(1.5);
  return pose_of(xyz, rpy);
}

Eigen::VectorXd drawn_numbers(test::Draw& draw, Eigen::Index count, double bound) {
  return bound * drawn_matrix(draw, count, 1);
}

}  // namespace

Robot drawn_robot(test::Draw& draw, const Plan& plan) {
  Robot robot;
  robot.root = plan.root;
  robot.links.resize(plan.parents.size() + 1);
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    Link& link = robot.links[i];
    link.name = fmt::format("link{}", i);
    link.inertia = drawn_body(draw);
    if (i == 0) continue;
    link.parent = plan.parents[i - 1];
    link.joint.kind = plan.joints[i - 1];
    link.joint.placement = drawn_pose(draw);
    link.joint.axis = (Eigen::Vector3d(0.3, 0.4, 0.5) + draw.vector(1.0)).normalized();
  }
  for (const int foot : plan.feet) {
    Contact contact;
    contact.link = foot;
    contact.frame.translation() = Eigen::Vector3d(0.1, 0.05, -0.2) + draw.vector(0.05);
    robot.contacts.push_back(contact);
  }
  return robot;
}

Sample drawn_sample(test::Draw& draw, const Robot& robot) {
  Sample sample;
  if (robot.root == Root::floating) {
    sample.base_angular_velocity = draw.vector(2.0);
    sample.base_angular_acceleration = draw.vector(10.0);
    sample.base_specific_force += draw.vector(4.0);
  }
  sample.q = drawn_numbers(draw, robot.joint_count(), 1.0);
  sample.dq = drawn_numbers(draw, robot.joint_count(), 3.0);
  sample.ddq = drawn_numbers(draw, robot.joint_count(), 20.0);
  sample.tau = Eigen::VectorXd::Zero(robot.joint_count());
  sample.in_contact.assign(robot.contacts.size(), true);
  return sample;
}

json robot_json(const Robot& robot) {
  json links = json::array(), contacts = json::array();
  for (const Link& link : robot.links) {
    json said = {{"parent", link.parent}};
    if (link.parent >= 0) {
      said.update(pose_json(link.joint.placement));
      said["axis"] = vector_json(link.joint.axis);
      said["joint"] = link.joint.kind == JointKind::prismatic ? "prismatic" : "revolute";
    }
    links.push_back(said);
  }
  for (const Contact& contact : robot.contacts) {
    json said = pose_json(contact.frame);
    said["link"] = contact.link;
    said["kind"] = contact.kind == ContactKind::point  ? "point"
                   : contact.kind == ContactKind::line ? "line"
                                                       : "plane";
    contacts.push_back(said);
  }
  return {{"root", robot.root == Root::floating ? "floating" : "fixed"},
          {"links", links},
          {"contacts", contacts}};
}

json sample_json(const Sample& sample) {
  return {{"angular_velocity", vector_json(sample.base_angular_velocity)},
          {"angular_acceleration", vector_json(sample.base_angular_acceleration)},
          {"specific_force", vector_json(sample.base_specific_force)},
          {"q", vector_json(sample.q)},
          {"dq", vector_json(sample.dq)},
          {"ddq", vector_json(sample.ddq)},
          {"tau", vector_json(sample.tau)}};
}

}  // namespace shapeid::vectors
