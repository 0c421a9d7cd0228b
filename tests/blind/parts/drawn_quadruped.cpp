#include "shapeid/tests/blind/parts/drawn_quadruped.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>

#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/blind/parts/draws.hpp"

namespace shapeid::blind {
namespace {

constexpr std::array<const char*, 4> legs = {"FR", "FL", "RR", "RL"};

std::string six_digits(const Eigen::Vector3d& v) {
  return fmt::format("{:.6f} {:.6f} {:.6f}", v.x(), v.y(), v.z());
}

/// Fixed axes x, y, z: R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Vector3d rpy(const Eigen::Matrix3d& R) {
  constexpr double upright = 1.0 - 1e-9;
  if (std::abs(R(2, 0)) > upright) {  // roll and yaw are one
    return {0.0, R(2, 0) < 0.0 ? 0.5 * pi : -0.5 * pi, std::atan2(-R(0, 1), R(1, 1))};
  }
  return {std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)), std::atan2(R(1, 0), R(0, 0))};
}

/// Of a link's frame against the base's: none in half of all, as drawings have it.
Eigen::Matrix3d quarters(Random& random) {
  if (chance(random, 0.5)) return Eigen::Matrix3d::Identity();
  const auto quarter = [&] { return 0.5 * pi * static_cast<double>(draw(random, 4)); };
  const double roll = quarter(), pitch = quarter(), yaw = quarter();
  return rotation_from_rpy({roll, pitch, yaw});
}

/// A box of uniform density, in axes of the base with the robot standing straight.
struct Body {
  double mass = 0.0;
  Eigen::Vector3d centre, edges, rpy;  ///< from the link's origin

  /// On the other side of the robot.
  [[nodiscard]] Body mirrored() const {
    Body other = *this;
    other.centre.y() *= -1.0;
    other.rpy = {-rpy.x(), rpy.y(), -rpy.z()};
    return other;
  }
};

Body body(Random& random, double lightest, double heaviest, const Eigen::Vector3d& centre,
          double askew, const Eigen::Vector3d& edges) {
  Body b;
  b.mass = random.uniform(lightest, heaviest);
  for (int i = 0; i < 3; ++i) {
    b.centre[i] = centre[i] + 0.01 * random.normal();
    b.edges[i] = edges[i] * random.uniform(0.8, 1.2);
  }
  for (double& angle : b.rpy) angle = askew * random.normal();
  return b;
}

/// In the link's frame, which has this orientation.
std::string inertial(const Body& b, const Eigen::Matrix3d& frame) {
  const Eigen::Vector3d e2 = b.edges.cwiseAbs2();
  const Eigen::Vector3d I = b.mass / 12.0 * (Eigen::Vector3d::Constant(e2.sum()) - e2);
  return fmt::format(
      R"(<inertial><origin xyz="{}" rpy="{}"/><mass value="{:.5f}"/>
      <inertia ixx="{:.6g}" ixy="0" ixz="0" iyy="{:.6g}" iyz="0" izz="{:.6g}"/></inertial>)",
      six_digits(frame.transpose() * b.centre),
      six_digits(rpy(frame.transpose() * rotation_from_rpy(b.rpy))), b.mass, I.x(), I.y(), I.z());
}

/// A joint of every leg and the link that it carries, as on the left.
struct Part {
  std::string name;
  Eigen::Vector3d place, axis;  ///< in axes of the base
  Eigen::Matrix3d frame;
  Body body;
};

struct Plan {
  Body base;
  double length = 0.0, width = 0.0;  ///< m, from the base's origin to the abduction joints
  std::array<Part, 3> leg;
  Eigen::Vector3d foot;  ///< from the knee
  double effort = 0.0;   ///< N m

  [[nodiscard]] double leg_length() const { return -leg[2].place.z() - foot.z(); }
  [[nodiscard]] double mass() const {
    double sum = base.mass;
    for (const Part& part : leg) sum += 4.0 * part.body.mass;
    return sum;
  }
};

Plan plan(Random& random) {
  Plan p;
  p.length = random.uniform(0.16, 0.23);
  p.width = random.uniform(0.04, 0.07);
  p.base =
      body(random, 3.5, 8.0, Eigen::Vector3d::Zero(), 0.05, {2.0 * p.length, 2.5 * p.width, 0.1});
  const double thigh = random.uniform(0.18, 0.24), shank = thigh * random.uniform(0.9, 1.1);
  const double aside = random.uniform(0.05, 0.1);
  const auto side = [&] { return chance(random, 0.5) ? 1.0 : -1.0; };
  const double inward = side(), forward = side();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  p.leg[0] = {"abad",
              {0, 0, 0},
              inward * x,
              quarters(random),
              body(random, 0.4, 0.8, {0, 0.4 * aside, 0}, 0.1, {0.08, 0.06, 0.08})};
  p.leg[1] = {"hip",
              {0, aside, 0},
              forward * y,
              quarters(random),
              body(random, 0.6, 1.3, {0, -0.01, -0.2 * thigh}, 0.1, {0.05, 0.05, 0.8 * thigh})};
  p.leg[2] = {"knee",
              {0, 0, -thigh},
              forward * y,
              quarters(random),
              body(random, 0.12, 0.3, {0, 0, -0.45 * shank}, 0.05, {0.02, 0.02, 0.8 * shank})};
  p.foot = {0.0, random.uniform(-0.005, 0.005), -shank};
  // Two legs carry the robot, half as bent again as they are when it stands.
  p.effort = 1.3 * gravity * p.mass() * thigh;
  return p;
}

std::string joint(const Part& part, const std::string& parent, const std::string& leg,
                  const Eigen::Vector3d& place, const Eigen::Matrix3d& parent_frame, double effort,
                  const Body& own) {
  return fmt::format(
      R"(  <joint name="{0}_{1}" type="revolute">
    <parent link="{2}"/><child link="{0}_{1}_link"/>
    <origin xyz="{3}" rpy="{4}"/><axis xyz="{5}"/>
    <limit lower="-3.1" upper="3.1" effort="{6:.1f}" velocity="21"/>
  </joint>
  <link name="{0}_{1}_link">
    {7}
  </link>
)",
      leg, part.name, parent, six_digits(parent_frame.transpose() * place),
      six_digits(rpy(parent_frame.transpose() * part.frame)),
      six_digits(part.frame.transpose() * part.axis), effort, inertial(own, part.frame));
}

std::string urdf(const std::string& name, const Plan& p) {
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  std::string out = fmt::format("<robot name=\"{}\">\n  <link name=\"base\">\n    {}\n  </link>\n",
                                name, inertial(p.base, level));
  for (const std::string leg : legs) {
    const double front = leg[0] == 'F' ? 1.0 : -1.0, left = leg[1] == 'L' ? 1.0 : -1.0;
    const Eigen::Vector3d mirror(1.0, left, 1.0);
    std::string parent = "base";
    Eigen::Matrix3d frame = level;
    Eigen::Vector3d place(front * p.length, p.width, 0.0);
    for (const Part& part : p.leg) {
      place += part.place;
      out += joint(part, parent, leg, mirror.cwiseProduct(place), frame, p.effort,
                   left > 0.0 ? part.body : part.body.mirrored());
      parent = fmt::format("{}_{}_link", leg, part.name);
      frame = part.frame;
      place.setZero();
    }
    out += fmt::format(
        R"(  <joint name="{0}_sole" type="fixed">
    <parent link="{1}"/><child link="{0}_foot"/><origin xyz="{2}"/>
  </joint>
  <link name="{0}_foot"/>
)",
        leg, parent, six_digits(frame.transpose() * mirror.cwiseProduct(p.foot)));
  }
  return out + "</robot>\n";
}

struct Mount {
  Eigen::Vector3d xyz, rpy;
};

/// Where the IMU is: any way round, some hang upside down, none is quite straight.
Mount mount(Random& random) {
  Mount imu;
  for (double& x : imu.xyz) x = random.uniform(-0.06, 0.06);
  const double over = chance(random, 0.3) ? pi : 0.0;
  imu.rpy = {over, 0.0, 0.5 * pi * static_cast<double>(draw(random, 4))};
  for (double& angle : imu.rpy) angle += 0.03 * random.normal();
  return imu;
}

/// A usual IMU, encoders behind a gear, torques from motor currents.
RobotNotes notes(Random& random, const Plan& p, const Mount& imu) {
  RobotNotes result;
  result.imu.translation() = imu.xyz;
  result.imu.linear() = rotation_from_rpy(imu.rpy);
  result.noise_sigma = {{"base.gyro", random.uniform(0.0007, 0.003)},
                        {"base.accel", random.uniform(0.015, 0.06)},
                        {"q", random.uniform(5e-5, 2e-4)},
                        {"dq", random.uniform(0.005, 0.02)},
                        {"tau", random.uniform(0.0015, 0.006) * p.effort}};
  result.expected_mass = {{"base", {0.6 * p.base.mass, 1.4 * p.base.mass}}, {"load", {0.0, 3.0}}};
  result.contacts_given = true;
  return result;
}

std::string yaml(const RobotNotes& notes, const Mount& imu) {
  std::string out = fmt::format("imu: {{xyz: [{}], rpy: [{}]}}\ncontacts:\n",
                                fmt::join(imu.xyz, ", "), fmt::join(imu.rpy, ", "));
  for (const char* leg : legs) out += fmt::format("  - {{link: {}_foot}}\n", leg);
  out += "noise:\n";
  for (const auto& [channel, sigma] : notes.noise_sigma) {
    out += fmt::format("  {}: {}\n", channel, sigma);
  }
  out += "expected_mass:\n";
  for (const auto& [link, range] : notes.expected_mass) {
    out += fmt::format("  {}: [{}, {}]\n", link, range.lower, range.upper);
  }
  return out;
}

}  // namespace

Machine drawn_quadruped(std::uint64_t seed) {
  Random random(seed);
  const Plan p = plan(random);
  Machine m;
  m.name = fmt::format("{}{}", quadruped_prefix, seed);
  m.urdf = urdf(m.name, p);
  const Mount imu = mount(random);
  m.notes = notes(random, p, imu);
  m.yaml = yaml(m.notes, imu);
  UrdfOptions floating;
  floating.root = Root::floating;
  m.robot = parse_urdf(m.urdf, m.name, floating).robot;
  for (const char* leg : legs) {
    const std::string foot = fmt::format("{}_foot", leg);
    const LinkSite site = m.robot.find_site(foot).value();
    m.robot.contacts.push_back({foot, site.link, ContactKind::point, site.pose});
  }
  m.free_links = {0};
  m.rate = std::array{250.0, 500.0, 1000.0}[draw(random, 3)];
  m.cutoff = std::array{25.0, 30.0, 40.0}[draw(random, 3)];
  m.trot.height = random.uniform(0.68, 0.76) * p.leg_length();
  m.trot.period = random.uniform(0.36, 0.46);
  m.trot.duty = random.uniform(0.54, 0.6);
  m.trot.clearance = random.uniform(0.04, 0.06);
  m.trot.speed = random.uniform(0.1, 0.3);
  return m;
}

}  // namespace shapeid::blind
