#include "shapeid/tests/fast/cases.hpp"

#include <rapidcheck.h>

#include <cmath>
#include <stdexcept>

#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::test {
namespace {

using Eigen::Vector3d;

void make_plain(Joint& joint) {
  joint.placement.linear().setIdentity();
  joint.axis = *rc::gen::element(1.0, -1.0) * Vector3d::Unit(*rc::gen::inRange(0, 3));
}

Link link_on(int parent, const Vector3d& origin, const Vector3d& axis) {
  Link link;
  link.parent = parent;
  link.joint.placement.translation() = origin;
  link.joint.axis = axis;
  link.inertia = from_centre(0.7, Vector3d(0.01, -0.02, -0.1),
                             Vector3d(0.004, 0.005, 0.002).asDiagonal().toDenseMatrix());
  return link;
}

Contact point_on(int link, const Vector3d& place) {
  Contact contact;
  contact.link = link;
  contact.frame.translation() = place;
  return contact;
}

Robot one_link(Root root) {
  Robot robot;
  robot.root = root;
  robot.links.resize(1);
  robot.links[0].inertia = link_on(-1, Vector3d::Zero(), Vector3d::UnitX()).inertia;
  return robot;
}

/// One leg below a floating base: hip, thigh and knee in one line at zero.
Robot one_leg() {
  Robot robot = one_link(Root::floating);
  robot.links.push_back(link_on(0, Vector3d(0.2, -0.05, 0.0), Vector3d::UnitX()));
  robot.links.push_back(link_on(1, Vector3d(0.0, -0.08, 0.0), Vector3d::UnitY()));
  robot.links.push_back(link_on(2, Vector3d(0.0, 0.0, -0.2), Vector3d::UnitY()));
  robot.contacts = {point_on(3, Vector3d(0.0, 0.0, -0.2))};
  return robot;
}

Robot chain_of(int links) {
  Robot robot = one_link(Root::floating);
  for (int i = 1; i < links; ++i) {
    robot.links.push_back(link_on(i - 1, Vector3d(0.01, 0.0, -0.1), Vector3d::Unit(i % 3)));
    robot.links.back().joint.kind = i % 7 == 0 ? JointKind::prismatic : JointKind::revolute;
  }
  robot.contacts = {point_on(links - 1, Vector3d(0.0, 0.02, -0.1)),
                    point_on(links / 2, Vector3d(0.03, 0.0, 0.0))};
  robot.contacts.back().kind = ContactKind::line;
  return robot;
}

void add_shapes(int link, BodyModel& model) {
  model.free_links.push_back(link);
  for (int k = 0; k < 2; ++k) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << 0.1, -0.05, 0.1 * k;
    model.shapes.push_back({link, make_cuboid(Vector3d(0.1, 0.2, 0.3), pose), std::to_string(k)});
  }
}

}  // namespace

Robot any_robot(int fewest_links, int most_links) {
  Robot robot =
      *test::robot({fewest_links, most_links, *rc::gen::element(Root::fixed, Root::floating)});
  for (Link& link : robot.links) {
    if (*rc::gen::arbitrary<bool>()) make_plain(link.joint);
  }
  if (!robot.contacts.empty() && *rc::gen::inRange(0, 4) == 0) {
    robot.contacts.push_back(robot.contacts.front());
  }
  if (!robot.contacts.empty() && *rc::gen::inRange(0, 4) == 0) {
    robot.contacts.push_back(robot.contacts.front());
    robot.contacts.back().frame.translation() += *vector3(0.2);
  }
  return robot;
}

Robot any_quadruped() {
  Robot robot = *test::robot({13, 13, Root::floating});
  robot.contacts.clear();
  for (int i = 1; i < 13; ++i) {
    Link& link = robot.links[static_cast<std::size_t>(i)];
    link.parent = i % 3 == 1 ? 0 : i - 1;
    if (*rc::gen::inRange(0, 3) != 0) make_plain(link.joint);
    if (*rc::gen::inRange(0, 8) != 0) link.joint.kind = JointKind::revolute;
    if (i % 3 == 0) robot.contacts.push_back(point_on(i, *vector3(0.3)));
  }
  return robot;
}

Sample any_sample(const Robot& robot) {
  Sample s = *test::sample(robot);
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    s.contact_force.push_back(*vector3(100.0));
  }
  return s;
}

BodyModel any_model(const Robot& robot) {
  BodyModel model;
  model.known = stacked_parameters(robot);
  for (int link = 0; link < robot.link_count(); ++link) {
    const int role = *rc::gen::inRange(0, 4);  // known, known to be nothing, sought, carries a load
    if (role == 1 || role == 2) model.known.segment<10>(Eigen::Index{10} * link).setZero();
    if (role >= 2) add_shapes(link, model);
  }
  return model;
}

BodyModel base_model(const Robot& robot) {
  BodyModel model;
  model.known = stacked_parameters(robot);
  model.known.head<10>().setZero();
  add_shapes(0, model);
  return model;
}

BodyModel whole_model(const Robot& robot) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(Eigen::Index{10} * robot.link_count());
  for (int link = 0; link < robot.link_count(); ++link) add_shapes(link, model);
  return model;
}

std::string bundled_file(const std::string& ending) {
  return SHAPEID_SOURCE_DIR "/models/robots/quadruped." + ending;
}

Robot bundled_quadruped() {
  Robot robot = read_urdf(bundled_file("urdf")).robot;
  static_cast<void>(read_robot_yaml(bundled_file("robot.yaml"), robot));
  return robot;
}

BodyModel bundled_shapes(const Robot& robot) {
  return read_shapes_yaml(bundled_file("shapes.yaml"), robot);
}

std::vector<NamedRobot> corner_robots() {
  std::vector<NamedRobot> robots = {{"one floating link", one_link(Root::floating)},
                                    {"one fixed link", one_link(Root::fixed)},
                                    {"one leg", one_leg()},
                                    {"sixty links", chain_of(60)},
                                    {"bundled quadruped", bundled_quadruped()}};
  Robot robot = one_link(Root::floating);
  robot.contacts = {point_on(0, Vector3d(0.1, 0.2, -0.3))};
  robots.push_back({"a foot alone", robot});
  robot = one_leg();
  robot.contacts.push_back(point_on(0, Vector3d(0.1, 0.2, -0.3)));
  robots.push_back({"a foot on the base", robot});
  robot = one_leg();
  robot.contacts.push_back(robot.contacts.front());
  robots.push_back({"a contact named twice", robot});
  robot = one_leg();
  robot.contacts.clear();
  robots.push_back({"no contact", robot});
  robot = one_leg();
  robot.root = Root::fixed;
  robots.push_back({"a fixed leg", robot});
  robot = one_leg();
  robot.contacts.front().kind = ContactKind::plane;
  robots.push_back({"a flat foot", robot});
  return robots;
}

Robot corner_robot(const std::string& name) {
  for (const NamedRobot& candidate : corner_robots()) {
    if (candidate.name == name) return candidate.robot;
  }
  throw std::invalid_argument(name);
}

std::vector<Sample> corner_samples(const Robot& robot) {
  std::vector<Sample> samples = {nothing_moves(robot)};
  Sample still = nothing_moves(robot);
  still.in_contact.assign(robot.contacts.size(), true);
  samples.push_back(still);
  for (double* input : inputs(still)) {
    *input = 1.0;
    samples.push_back(still);
    *input = 0.0;
  }
  Sample moving = still;
  for (Eigen::Index j = 0; j < robot.joint_count(); ++j) {
    const double phase = static_cast<double>(j);
    moving.q[j] = 0.3 + 0.1 * phase;
    moving.dq[j] = std::sin(1.0 + phase);
    moving.ddq[j] = std::sin(2.0 + phase);
    moving.tau[j] = std::sin(3.0 + phase);
  }
  for (Vector3d& f : moving.contact_force) f << 3.0, -2.0, 40.0;
  moving.base_angular_velocity << 0.3, -0.5, 0.7;
  moving.base_angular_acceleration << -1.1, 0.4, 0.9;
  moving.base_specific_force << 0.2, -0.3, 9.7;
  for (int turn = -12; turn <= 12; ++turn) {
    samples.push_back(moving);
    samples.back().q.array() += 0.5 * turn;
  }
  for (const double factor : {1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6}) {
    samples.push_back(moving);
    samples.back().dq *= factor;
  }
  return samples;
}

Sample nothing_moves(const Robot& robot) {
  Sample s;
  s.base_specific_force.setZero();
  s.q = s.dq = s.ddq = s.tau = Eigen::VectorXd::Zero(robot.joint_count());
  s.in_contact.assign(robot.contacts.size(), false);
  s.contact_force.assign(robot.contacts.size(), Vector3d::Zero());
  return s;
}

std::vector<double*> inputs(Sample& s) {
  std::vector<double*> all;
  const auto gather = [&all](auto& v) {
    for (Eigen::Index i = 0; i < v.size(); ++i) all.push_back(&v[i]);
  };
  gather(s.base_angular_velocity);
  gather(s.base_angular_acceleration);
  gather(s.base_specific_force);
  gather(s.q);
  gather(s.dq);
  gather(s.ddq);
  return all;
}

}  // namespace shapeid::test
