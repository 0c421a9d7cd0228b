#include "shapeid/tests/app/arms.hpp"

#include <fmt/format.h>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/simbody/joint_trajectory.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {
namespace {

std::string words(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string link_text(int link, const BoxMasses& masses) {
  const InertialParameters body = arm_link(link, masses);
  const Eigen::Matrix3d I = body.tensor_about_centre();
  std::string text = fmt::format(
      "  <link name=\"l{}\">\n    <inertial><origin xyz=\"{}\"/><mass value=\"{}\"/>\n      "
      "<inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>\n",
      link, words(body.centre_of_mass()), body.mass(), I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2),
      I(2, 2));
  for (const PlacedBox& box : boxes_of_arm(link)) {
    text += fmt::format(
        "    <collision><origin xyz=\"{}\"/><geometry><box size=\"{}\"/></geometry></collision>\n",
        words(box.centre), words(box.sides));
  }
  return text + "  </link>\n";
}

/// The first joint of an arm turns about a level axis, the others about axes askew to each other.
std::string joint_text(int link) {
  const double i = link;
  const bool first = link <= 2;
  return fmt::format(
      "  <joint name=\"j{0}\" type=\"revolute\"><parent link=\"l{1}\"/><child link=\"l{0}\"/>\n    "
      "<origin xyz=\"{2} {3} {4}\" rpy=\"{5}\"/><axis xyz=\"{6}\"/>\n    "
      "<limit lower=\"-1.6\" upper=\"1.4\" effort=\"500\" velocity=\"5\"/></joint>\n",
      link, first ? 0 : link - 2, 0.03 + 0.01 * i, first ? 0.7 * i - 1.0 : 0.04, 0.15 - 0.01 * i,
      first ? "1.5707963267948966 0 0.4" : fmt::format("{} {} {}", 0.9, 0.2 * i - 1.3, 0.5),
      first ? "0 0 1" : fmt::format("{} 0.6 {}", 0.1 * i - 0.4, 0.9 - 0.1 * i));
}

}  // namespace

std::vector<BoxMasses> masses_of_arms() {
  std::vector<BoxMasses> masses;
  masses.reserve(links_of_arms);
  for (int link = 0; link < links_of_arms; ++link) {
    masses.push_back({0.4 + 0.07 * link, 1.1 - 0.05 * link});
  }
  return masses;
}

std::array<PlacedBox, 2> boxes_of_arm(int link) {
  const double i = link;
  return {
      {{{0.05 + 0.003 * i, -0.02 + 0.004 * i, 0.06}, {0.12 - 0.004 * i, 0.05, 0.08 + 0.005 * i}},
       {{-0.06, 0.05 - 0.005 * i, 0.002 * i - 0.04}, {0.05, 0.11 - 0.003 * i, 0.06}}}};
}

InertialParameters arm_link(int link, const BoxMasses& masses) {
  const auto [one, other] = boxes_of_arm(link);
  return cuboid_body(masses[0], one.centre, one.sides) +
         cuboid_body(masses[1], other.centre, other.sides);
}

std::string arms_urdf(const std::vector<BoxMasses>& masses) {
  std::string text = "<robot name=\"arms\">\n  <link name=\"l0\"/>\n";
  for (int link = 1; link < links_of_arms; ++link) {
    text += link_text(link, masses[static_cast<std::size_t>(link)]) + joint_text(link);
  }
  return text + "</robot>\n";
}

Robot read_arms(const std::string& path) {
  UrdfOptions options;
  options.root = Root::fixed;
  return read_urdf(path, options).robot;
}

void write_arms_log(const std::string& name, const std::vector<BoxMasses>& masses,
                    const NoiseOfArms& noise) {
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  const Robot robot = parse_urdf(arms_urdf(masses), name, fixed).robot;
  std::vector<std::string> columns = {"time"};
  for (const char* quantity : {"q", "dq", "ddq", "tau"}) {
    for (int j = 0; j < robot.joint_count(); ++j) {
      columns.push_back(fmt::format("{}.{}", quantity, robot.joint(j).name));
    }
  }
  LogWriter log(scratch() + "/" + name + ".csv", columns);
  Draw draw(3);
  JointTrajectoryOptions motion;
  motion.rate = 100.0;
  simulate_joint_trajectory(robot, motion, [&](const Sample& s) {
    std::vector<double> row = {s.time};
    for (const Eigen::VectorXd* v : {&s.q, &s.dq, &s.ddq}) {
      row.insert(row.end(), v->begin(), v->end());
    }
    for (Eigen::Index j = 0; j < s.tau.size(); ++j) {
      row.push_back(s.tau[j] + (j % 2 == 0 ? noise.odd : noise.even) * draw.normal());
    }
    log.write(row);
  });
  log.close();
}

}  // namespace shapeid::test
