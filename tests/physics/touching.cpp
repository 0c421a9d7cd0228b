#include "shapeid/tests/physics/touching.hpp"

#include <vector>

#include "shapeid/tests/support/generators.hpp"

namespace shapeid::test {
namespace {

enum class Redundancy { none, named_twice, three_more_points };

Robot with_redundancy(Robot robot, Redundancy redundancy) {
  const Contact first = robot.contacts.front();
  if (redundancy == Redundancy::named_twice) robot.contacts.push_back(first);
  if (redundancy == Redundancy::three_more_points) {
    for (int axis = 0; axis < 3; ++axis) {
      robot.contacts.push_back(first);
      robot.contacts.back().kind = ContactKind::point;
      robot.contacts.back().frame.translation() += 0.1 * Eigen::Vector3d::Unit(axis);
    }
  }
  return robot;
}

}  // namespace

rc::Gen<Robot> touching_robot() {
  return rc::gen::suchThat(
      rc::gen::oneOf(robot({1, 12, Root::floating}), robot({2, 12, Root::fixed})),
      [](const Robot& r) { return !r.contacts.empty(); });
}

rc::Gen<std::pair<Robot, Sample>> robot_in_contact() {
  const auto robots = rc::gen::map(
      rc::gen::pair(touching_robot(), rc::gen::element(Redundancy::none, Redundancy::named_twice,
                                                       Redundancy::three_more_points)),
      [](const auto& drawn) { return with_redundancy(drawn.first, drawn.second); });
  return rc::gen::mapcat(robots, [](const Robot& r) {
    return rc::gen::map(sample(r), [r](const Sample& s) { return std::pair(r, s); });
  });
}

rc::Gen<Eigen::VectorXd> weights(Eigen::Index size) {
  return rc::gen::map(
      rc::gen::container<std::vector<double>>(static_cast<std::size_t>(size), magnitude(1e-2, 1e2)),
      [](const std::vector<double>& w) -> Eigen::VectorXd {
        return Eigen::Map<const Eigen::VectorXd>(w.data(), static_cast<Eigen::Index>(w.size()));
      });
}

Robot leg(Root root) {
  Robot robot;
  robot.root = root;
  robot.links.resize(3);
  for (int i = 1; i < 3; ++i) {
    Link& link = robot.links[static_cast<std::size_t>(i)];
    link.parent = i - 1;
    link.joint.axis = Eigen::Vector3d::UnitY();
  }
  robot.links[1].joint.placement.translation() << 0.07, 0.02, -0.11;
  robot.links[2].joint.placement.translation() << 0.0, 0.01, -0.35;
  Contact foot;
  foot.link = 2;
  foot.frame.translation() << 0.0, 0.03, -0.31;
  robot.contacts = {foot};
  return robot;
}

Sample posture(double hip, double knee) {
  Sample s;
  s.q = Eigen::Vector2d(hip, knee);
  s.dq = s.ddq = s.tau = Eigen::Vector2d::Zero();
  return s;
}

}  // namespace shapeid::test
