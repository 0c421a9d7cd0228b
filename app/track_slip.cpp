#include "shapeid/app/track_slip.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid::app {
namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

SlipWatch::SlipWatch(const Robot& robot, double rate)
    : robot_(robot),
      kinematics_(robot),
      jacobian_(robot),
      samples_(static_cast<std::size_t>(std::ceil(shortest * rate))),
      moving_(robot.contacts.size(), 0) {}

std::vector<int> SlipWatch::watch(const Sample& sample) {
  kinematics_.start(sample);
  jacobian_.update(kinematics_, sample);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(robot_.dof());
  if (robot_.root == Root::floating) v.segment<3>(3) = sample.base_angular_velocity;
  v.tail(robot_.joint_count()) = sample.dq;
  const Eigen::VectorXd velocities = jacobian_.transposed().transpose() * v;

  std::vector<std::size_t> touching;
  std::vector<Eigen::Vector3d> seen_from_base;
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < sample.in_contact.size(); ++c) {
    if (!sample.in_contact[c]) {
      moving_[c] = 0;
      continue;
    }
    touching.push_back(c);
    seen_from_base.emplace_back(velocities.segment<3>(row));
    row += force_numbers(robot_.contacts[c].kind);
  }
  Eigen::Vector3d common = Eigen::Vector3d::Zero();  // a fixed base stands still
  if (robot_.root == Root::floating && !touching.empty()) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> component;
      component.reserve(seen_from_base.size());
      for (const Eigen::Vector3d& u : seen_from_base) component.push_back(u[axis]);
      common[axis] = median(std::move(component));
    }
  }
  std::vector<int> slipping;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    std::size_t& moving = moving_[touching[i]];
    moving = (seen_from_base[i] - common).norm() > fastest ? moving + 1 : 0;
    if (moving >= samples_) slipping.push_back(static_cast<int>(touching[i]));
  }
  return slipping;
}

}  // namespace shapeid::app
