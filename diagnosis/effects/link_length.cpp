#include <cstddef>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double shortest = 0.02;  // m: what is shorter has no direction to be longer in

bool has_length(const Robot& robot, int joint) {
  return robot.links[static_cast<std::size_t>(joint) + 1].parent > 0 &&
         robot.joint(joint).placement.translation().norm() > shortest;
}

void stretch(Robot& robot, int joint, const Eigen::VectorXd& value) {
  auto place = robot.links[static_cast<std::size_t>(joint) + 1].joint.placement.translation();
  place += value[0] * place.normalized();
}

}  // namespace

Effect link_length() {
  Effect e;
  e.id = "link_length";
  e.title = "the joint is farther from the one before it than the model says";
  e.equation = "placement of joint j moved by d along itself, in Y and J";
  e.site = SiteKind::joint;
  e.parameters = {{"d", "m", false, 0.005, 0.05}};
  e.confused_with = {"masses beyond the joint", "contact_point"};
  e.separate_by = "measure the link";
  e.under_contact = "seen where the foot then is";
  e.source = "Hollerbach, Khalil, Gautier, Springer Handbook of Robotics (2016), ch. 6";
  e.built_in = true;
  e.applies = has_length;
  e.transform.robot = stretch;
  return e;
}

}  // namespace shapeid::diagnosis
