#include "shapeid/tests/robot/urdf_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shapeid/tests/support/generators.hpp"

namespace shapeid::test {
namespace {

/// Rz(yaw) Ry(pitch) Rx(roll) and a translation, sines and cosines written out.
Eigen::Matrix4d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  const auto [cr, sr] = std::pair(std::cos(rpy.x()), std::sin(rpy.x()));
  const auto [cp, sp] = std::pair(std::cos(rpy.y()), std::sin(rpy.y()));
  const auto [cy, sy] = std::pair(std::cos(rpy.z()), std::sin(rpy.z()));
  Eigen::Matrix4d T;
  T << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz.x(),  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz.y(),   //
      -sp, cp * sr, cp * cr, xyz.z(),                                     //
      0, 0, 0, 1;
  return T;
}

std::string three(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

/// Of every kind that turns with its frame, and the sphere; sides and lengths tell links apart.
std::string geometry_text(std::size_t i) {
  const double size = 1.0 + static_cast<double>(i);
  switch (i % 3) {
    case 0:
      return fmt::format("<box size=\"{} {} {}\"/>", size, size + 0.25, size + 0.5);
    case 1:
      return fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", size, size + 0.25);
    default:
      return fmt::format("<sphere radius=\"{}\"/>", size);
  }
}

std::string link_text(const WrittenLink& link, std::size_t i) {
  double mass = 0.0;
  Eigen::Matrix3d I = Eigen::Matrix3d::Zero();
  for (const PointPair& p : link.points) {
    mass += 2.0 * p.mass;
    const double x = p.arm.x(), y = p.arm.y(), z = p.arm.z();
    Eigen::Matrix3d own;
    own << y * y + z * z, -x * y, -x * z,  //
        -x * y, x * x + z * z, -y * z,     //
        -x * z, -y * z, x * x + y * y;
    I += 2.0 * p.mass * own;
  }
  return fmt::format(
      "  <link name=\"l{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"{}\"/>\n"
      "      <mass value=\"{}\"/>\n      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" "
      "iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n    <collision>\n      <origin xyz=\"{}\" "
      "rpy=\"{}\"/>\n      <geometry>{}</geometry>\n    </collision>\n"
      "  </link>\n",
      i, three(link.inertial_xyz), three(link.inertial_rpy), mass, I(0, 0), I(0, 1), I(0, 2),
      I(1, 1), I(1, 2), I(2, 2), three(link.inertial_xyz), three(link.inertial_rpy),
      geometry_text(i));
}

std::string joint_text(const WrittenLink& link, std::size_t i) {
  return fmt::format(
      "  <joint name=\"j{}\" type=\"{}\">\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n"
      "    <parent link=\"l{}\"/>\n    <child link=\"l{}\"/>\n    <axis xyz=\"{}\"/>\n"
      "    <limit lower=\"-1\" upper=\"2\" effort=\"30\" velocity=\"7\"/>\n  </joint>\n",
      i, link.joint, three(link.joint_xyz), three(link.joint_rpy), link.parent, i,
      three(link.axis));
}

rc::Gen<PointPair> point_pair() {
  return rc::gen::map(rc::gen::pair(magnitude(0.05, 5.0), vector3(0.3)), [](const auto& drawn) {
    return PointPair{drawn.first, drawn.second};
  });
}

rc::Gen<WrittenLink> written_link() {
  const auto joint = rc::gen::weightedElement<std::string>(
      {{3, "fixed"}, {1, "revolute"}, {1, "continuous"}, {1, "prismatic"}});
  return rc::gen::map(rc::gen::tuple(rc::gen::inRange(0, 1 << 20), joint,
                                     rc::gen::tuple(vector3(0.5), vector3(3.0), direction()),
                                     rc::gen::pair(vector3(0.3), vector3(3.0)),
                                     rc::gen::container<std::vector<PointPair>>(4, point_pair())),
                      [](const auto& t) {
                        WrittenLink link;
                        link.parent = std::get<0>(t);
                        link.joint = std::get<1>(t);
                        std::tie(link.joint_xyz, link.joint_rpy, link.axis) = std::get<2>(t);
                        std::tie(link.inertial_xyz, link.inertial_rpy) = std::get<3>(t);
                        link.points = std::get<4>(t);
                        return link;
                      });
}

/// A permutation of 0 ... count - 1 that shrinks to the identity: sorting keys that shrink to zero.
rc::Gen<std::vector<std::size_t>> permutation(std::size_t count) {
  return rc::gen::map(rc::gen::container<std::vector<int>>(count, rc::gen::inRange(0, 1 << 20)),
                      [](const std::vector<int>& keys) {
                        std::vector<std::size_t> order(keys.size());
                        std::iota(order.begin(), order.end(), std::size_t{0});
                        std::stable_sort(
                            order.begin(), order.end(),
                            [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
                        return order;
                      });
}

}  // namespace

std::string WrittenRobot::text() const {
  std::string out = "<?xml version=\"1.0\"?>\n<robot name=\"written\">\n";
  for (const std::size_t i : link_order) out += link_text(links[i], i);
  for (const std::size_t i : joint_order) {
    if (i > 0) out += joint_text(links[i], i);
  }
  return out + "</robot>\n";
}

Eigen::Matrix4d WrittenRobot::pose(std::size_t i) const {
  if (i == 0) return Eigen::Matrix4d::Identity();
  const WrittenLink& link = links[i];
  return pose(static_cast<std::size_t>(link.parent)) * pose_of(link.joint_xyz, link.joint_rpy);
}

Eigen::Matrix4d WrittenRobot::collision_pose(std::size_t i) const {
  return pose(i) * pose_of(links[i].inertial_xyz, links[i].inertial_rpy);
}

InertialParameters WrittenRobot::summed(const std::vector<std::size_t>& which,
                                        std::size_t about) const {
  const Eigen::Matrix4d to_about = pose(about).inverse();
  InertialParameters sum;
  for (const std::size_t i : which) {
    const WrittenLink& link = links[i];
    const Eigen::Matrix4d T = to_about * pose(i) * pose_of(link.inertial_xyz, link.inertial_rpy);
    for (const PointPair& p : link.points) {
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d r = (T * (sign * p.arm).homogeneous()).head<3>();
        const double x = r.x(), y = r.y(), z = r.z();
        Vector10 moments;
        moments << 1, x, y, z, y * y + z * z, -x * y, -x * z, x * x + z * z, -y * z, x * x + y * y;
        sum.values += p.mass * moments;
      }
    }
  }
  return sum;
}

rc::Gen<WrittenRobot> written_robot() {
  return rc::gen::mapcat(rc::gen::inRange<std::size_t>(1, 12), [](std::size_t count) {
    return rc::gen::map(
        rc::gen::tuple(rc::gen::container<std::vector<WrittenLink>>(count, written_link()),
                       permutation(count), permutation(count)),
        [](const auto& drawn) {
          WrittenRobot robot;
          std::tie(robot.links, robot.joint_order, robot.link_order) = drawn;
          for (std::size_t i = 1; i < robot.links.size(); ++i) {
            robot.links[i].parent %= static_cast<int>(i);
          }
          return robot;
        });
  });
}

}  // namespace shapeid::test
