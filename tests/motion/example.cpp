#include "shapeid/tests/motion/example.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "shapeid/models/log_writer.hpp"

namespace shapeid::test {
namespace {

/// Value, first and second derivative of a sum of three sines; `phase` tells quantities apart.
std::array<double, 3> wave(double phase, double time) {
  std::array<double, 3> x = {};
  for (const double frequency : {0.31, 0.83, 1.7}) {
    const double w = 2.0 * std::numbers::pi * frequency, a = w * time + phase / frequency;
    x[0] += 0.2 * std::sin(a);
    x[1] += 0.2 * w * std::cos(a);
    x[2] -= 0.2 * w * w * std::sin(a);
  }
  return x;
}

}  // namespace

Robot chain(int joints, Root root) {
  Robot robot;
  robot.name = "chain";
  robot.root = root;
  robot.links.push_back({});
  robot.links.back().name = "base";
  const std::array<Eigen::Vector3d, 3> axes = {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ(),
                                               Eigen::Vector3d::UnitX()};
  for (int j = 0; j < joints; ++j) {
    Link link;
    link.name = fmt::format("l{}", j);
    link.parent = j;
    link.joint.name = fmt::format("j{}", j);
    link.joint.axis = axes[static_cast<std::size_t>(j) % 3];
    link.joint.lower = -2.5;
    link.joint.upper = 2.5;
    robot.links.push_back(link);
  }
  return robot;
}

Sample smooth_motion(const Robot& robot, double time) {
  const int n = robot.joint_count();
  Sample s;
  s.time = time;
  s.q = s.dq = s.ddq = s.tau = Eigen::VectorXd(n);
  for (int j = 0; j < n; ++j) {
    const auto x = wave(0.3 + j, time);
    s.q[j] = x[0];
    s.dq[j] = x[1];
    s.ddq[j] = x[2];
    s.tau[j] = 10.0 * wave(0.7 + j, time)[0] + 3.0 * x[2];
  }
  if (robot.root == Root::floating) {
    for (int k = 0; k < 3; ++k) {
      const auto x = wave(-1.0 - k, time);
      s.base_angular_velocity[k] = x[0];
      s.base_angular_acceleration[k] = x[1];
      s.base_specific_force[k] = wave(-5.0 - k, time)[0] + (k == 2 ? 9.81 : 0.0);
    }
  }
  return s;
}

std::vector<std::string> log_columns(const Robot& robot) {
  std::vector<std::string> names = {"time"};
  if (robot.root == Root::floating) {
    for (const char* quantity : {"base.gyro", "base.accel", "base.gyrodot"}) {
      for (const char* axis : {"x", "y", "z"})
        names.push_back(fmt::format("{}.{}", quantity, axis));
    }
  }
  for (const char* quantity : {"q", "dq", "ddq", "tau"}) {
    for (int j = 0; j < robot.joint_count(); ++j) {
      names.push_back(fmt::format("{}.{}", quantity, robot.joint(j).name));
    }
  }
  for (const Contact& contact : robot.contacts) names.push_back("contact." + contact.name);
  return names;
}

std::vector<double> log_row(const Robot& robot, const Sample& s) {
  std::vector<double> row = {s.time};
  const auto append = [&](const Eigen::VectorXd& x) { row.insert(row.end(), x.begin(), x.end()); };
  if (robot.root == Root::floating) {
    append(s.base_angular_velocity);
    append(s.base_specific_force);
    append(s.base_angular_acceleration);
  }
  for (const Eigen::VectorXd* x : {&s.q, &s.dq, &s.ddq, &s.tau}) append(*x);
  for (const bool touches : s.in_contact) row.push_back(touches ? 1.0 : 0.0);
  return row;
}

void write_log(const std::string& path, const Robot& robot, const std::vector<double>& times,
               const std::function<Sample(double)>& motion) {
  LogWriter writer(path, log_columns(robot));
  for (const double time : times) writer.write(log_row(robot, motion(time)));
  writer.close();
}

std::vector<double> regular_times(double start, double rate, int count) {
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) times.push_back(start + k / rate);
  return times;
}

ReadMotion read_motion(const std::string& path, const Robot& robot, const MotionOptions& options,
                       const std::optional<Mapping>& mapping, const RobotNotes& notes) {
  MotionReader reader(path, robot, notes, mapping, options);
  ReadMotion motion;
  while (std::optional<Sample> sample = reader.next()) motion.samples.push_back(*sample);
  motion.report = reader.report();
  return motion;
}

}  // namespace shapeid::test
