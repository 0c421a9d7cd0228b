#include "shapeid/models/simbody/sensors.hpp"

#include "shapeid/models/sample_builder.hpp"

namespace shapeid {

Sensors::Sensors(const Robot& robot, const RobotNotes& notes, const SensorOptions& options)
    : notes_(notes),
      rotor_inertias_(rotor_inertias(robot)),
      options_(options),
      floating_(robot.root == Root::floating),
      random_(options.seed) {
  const auto add_axes = [&](const std::string& quantity, const std::string& name) {
    for (const char* axis : {".x", ".y", ".z"}) add(name + axis, quantity);
  };
  const auto add_joints = [&](const std::string& quantity) {
    for (int j = 0; j < robot.joint_count(); ++j) {
      add(quantity + "." + robot.joint(j).name, quantity);
    }
  };
  add("time", "");
  if (floating_) {
    add_axes("base.gyro", "base.gyro");
    add_axes("base.accel", "base.accel");
    for (const char* part : {".w", ".x", ".y", ".z"}) add(std::string("base.quat") + part, "");
  }
  add_joints("q");
  add_joints("dq");
  add_joints("tau");
  for (const Contact& contact : robot.contacts) add("contact." + contact.name, "");
  if (!options.exact_extras) return;
  if (floating_) add_axes("", "base.gyrodot");
  for (int j = 0; j < robot.joint_count(); ++j) add("ddq." + robot.joint(j).name, "");
  for (const Contact& contact : robot.contacts) add_axes("", "force." + contact.name);
}

void Sensors::add(const std::string& column, const std::string& quantity) {
  columns_.push_back(column);
  double sigma = 0.0;
  if (options_.noise && !quantity.empty()) {
    const auto own = notes_.noise_sigma.find(column);
    const auto shared = notes_.noise_sigma.find(quantity);
    if (own != notes_.noise_sigma.end()) {
      sigma = own->second;
    } else if (shared != notes_.noise_sigma.end()) {
      sigma = shared->second;
    }
  }
  sigma_.push_back(sigma);
}

std::vector<double> Sensors::measure(const Sample& s, const Eigen::Quaterniond& attitude) {
  std::vector<double> row;
  row.reserve(columns_.size());
  const auto put = [&row](const auto& numbers) {
    row.insert(row.end(), numbers.data(), numbers.data() + numbers.size());
  };
  const Eigen::Matrix3d to_imu = notes_.imu.linear().transpose();
  const Eigen::Vector3d r = notes_.imu.translation();
  const Eigen::Vector3d& w = s.base_angular_velocity;
  const Eigen::Vector3d& dw = s.base_angular_acceleration;

  row.push_back(s.time);
  if (floating_) {
    put(Eigen::Vector3d(to_imu * w));
    put(Eigen::Vector3d(to_imu * (s.base_specific_force + dw.cross(r) + w.cross(w.cross(r)))));
    put(Eigen::Vector4d(attitude.w(), attitude.x(), attitude.y(), attitude.z()));
  }
  put(s.q);
  put(s.dq);
  put(Eigen::VectorXd(s.tau + rotor_inertias_.cwiseProduct(s.ddq)));  // what the drives give
  for (const bool touches : s.in_contact) row.push_back(touches ? 1.0 : 0.0);
  if (options_.exact_extras) {
    if (floating_) put(Eigen::Vector3d(to_imu * dw));
    put(s.ddq);
    for (const Eigen::Vector3d& force : s.contact_force) put(force);
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (sigma_[i] > 0.0) row[i] += sigma_[i] * random_.normal();
  }
  return row;
}

}  // namespace shapeid
