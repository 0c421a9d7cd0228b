#include "shapeid/tests/blind/parts/drawn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/blind/parts/draws.hpp"

namespace shapeid::blind {
namespace {

std::string four_digits(const Eigen::Vector3d& v) {
  return fmt::format("{:.4f} {:.4f} {:.4f}", v.x(), v.y(), v.z());
}

/// Mostly along the frame's axes, as drawings have it, else any.
Eigen::Vector3d axis(Random& random) {
  if (chance(random, 0.25)) return direction(random);
  const double sign = chance(random, 0.5) ? 1.0 : -1.0;
  return sign * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(draw(random, 3)));
}

/// Quarter turns, or any.
Eigen::Vector3d turn(Random& random) {
  Eigen::Vector3d rpy;
  const bool quarters = chance(random, 0.6);
  for (double& angle : rpy) {
    angle = quarters ? 0.5 * pi * static_cast<double>(draw(random, 4)) : random.uniform(-pi, pi);
  }
  return rpy;
}

/// So far, m, in any direction. One is drawn before the other: compilers differ in which operand of
/// a product they draw first, and a seed would be another arm.
Eigen::Vector3d away(Random& random, double least, double most) {
  const Eigen::Vector3d where = direction(random);
  return random.uniform(least, most) * where;
}

struct DrawnLink {
  bool slides = false;
  Eigen::Vector3d place, rpy, axis;  ///< of its joint
  double half_range = 0.0, velocity = 0.0;
  Eigen::Vector3d centre, inertia_rpy, edges;
  double mass = 0.0;

  [[nodiscard]] double reach() const {
    return place.norm() + (slides ? half_range : 0.0) + centre.norm();
  }
};

std::vector<DrawnLink> links(Random& random) {
  std::vector<DrawnLink> all(2 + draw(random, 5));
  double mass = random.uniform(2.0, 8.0);
  for (DrawnLink& link : all) {
    link.slides = chance(random, 1.0 / 8.0);
    // Where axes meet, as in a wrist, there is no length.
    const bool meets = chance(random, 0.2);
    link.place = meets ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : away(random, 0.05, 0.4);
    link.rpy = turn(random);
    link.axis = axis(random);
    link.half_range = link.slides ? random.uniform(0.15, 0.5) : random.uniform(1.0, 2.8);
    link.velocity = link.slides ? random.uniform(0.5, 1.5) : random.uniform(1.5, 4.0);
    link.centre = away(random, 0.02, 0.2);
    link.inertia_rpy = turn(random);
    for (double& edge : link.edges) edge = random.uniform(0.05, 0.35);
    link.mass = mass;
    mass = std::max(0.2, mass * random.uniform(0.4, 0.95));
  }
  return all;
}

/// N m or N: what its links weigh at their full reach, with half as much for their motion.
double effort(const std::vector<DrawnLink>& all, std::size_t joint) {
  double reach = 0.0, sum = 0.0;
  for (std::size_t i = joint; i < all.size(); ++i) {
    reach += all[i].reach();
    sum += gravity * all[i].mass * (all[joint].slides ? 1.0 : reach);
  }
  return 1.5 * sum;
}

std::string urdf(const std::string& name, const std::vector<DrawnLink>& all) {
  std::string out = fmt::format("<robot name=\"{}\">\n  <link name=\"link0\"/>\n", name);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const DrawnLink& link = all[i];
    const Eigen::Vector3d e2 = link.edges.cwiseAbs2();
    const Eigen::Vector3d I = link.mass / 12.0 * (Eigen::Vector3d::Constant(e2.sum()) - e2);
    out += fmt::format(
        R"(  <joint name="joint{0}" type="{2}">
    <parent link="link{1}"/><child link="link{0}"/>
    <origin xyz="{3}" rpy="{4}"/><axis xyz="{5}"/>
    <limit lower="{6:.3f}" upper="{7:.3f}" effort="{8:.1f}" velocity="{9:.2f}"/>
  </joint>
  <link name="link{0}">
    <inertial><origin xyz="{10}" rpy="{11}"/><mass value="{12:.4f}"/>
      <inertia ixx="{13:.6g}" ixy="0" ixz="0" iyy="{14:.6g}" iyz="0" izz="{15:.6g}"/></inertial>
  </link>
)",
        i + 1, i, link.slides ? "prismatic" : "revolute", four_digits(link.place),
        four_digits(link.rpy), four_digits(link.axis), -link.half_range, link.half_range,
        effort(all, i), link.velocity, four_digits(link.centre), four_digits(link.inertia_rpy),
        link.mass, I.x(), I.y(), I.z());
  }
  return out + "</robot>\n";
}

/// Torques to a few thousandths of the effort, joint by joint; encoders behind a gear.
RobotNotes notes(Random& random, const Robot& robot) {
  RobotNotes result;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Joint& joint = robot.joint(j);
    const double scale = joint.kind == JointKind::prismatic ? 0.3 : 1.0;
    result.noise_sigma["tau." + joint.name] = random.uniform(0.0005, 0.003) * joint.effort;
    result.noise_sigma["q." + joint.name] = scale * random.uniform(2e-5, 1e-4);
    result.noise_sigma["dq." + joint.name] = scale * random.uniform(0.003, 0.02);
  }
  return result;
}

std::string yaml(const RobotNotes& notes) {
  std::string out = "noise:\n";
  for (const auto& [channel, sigma] : notes.noise_sigma) {
    out += fmt::format("  {}: {}\n", channel, sigma);
  }
  return out;
}

}  // namespace

Machine drawn_arm(std::uint64_t seed) {
  Random random(seed);
  Machine m;
  m.name = fmt::format("{}{}", drawn_prefix, seed);
  m.urdf = urdf(fmt::format("drawn{}", seed), links(random));
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  m.robot = parse_urdf(m.urdf, m.name, fixed).robot;
  m.notes = notes(random, m.robot);
  m.yaml = yaml(m.notes);
  for (int link = 1; link < m.robot.link_count(); ++link) m.free_links.push_back(link);
  m.rate = std::array{250.0, 500.0, 1000.0}[draw(random, 3)];
  m.cutoff = std::array{8.0, 10.0, 15.0, 20.0}[draw(random, 4)];
  m.frequency = random.uniform(0.12, 0.3);
  return m;
}

}  // namespace shapeid::blind
