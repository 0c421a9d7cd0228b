// Random URDFs whose every number is known before the reader sees it: links are clouds of point
// masses, so that masses, centres and tensors of any sum of links are sums over points.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Core>

#include <string>
#include <vector>

#include "shapeid/models/inertia.hpp"

namespace shapeid::test {

/// One of two equal point masses at plus and minus `arm` from the centre of mass, so that the
/// pair's centre stays there.
struct PointPair {
  double mass = 0.0;    ///< kg, each
  Eigen::Vector3d arm;  ///< m, in the inertial frame's axes
};

/// A link and the joint that carries it, in the words of URDF.
struct WrittenLink {
  int parent = -1;    ///< index of an earlier link
  std::string joint;  ///< type of the joint to the parent
  Eigen::Vector3d joint_xyz, joint_rpy, axis;
  Eigen::Vector3d inertial_xyz, inertial_rpy;
  std::vector<PointPair> points;
};

/// Links l0, l1, ... and joints j1, j2, ...; joint j<i> carries link l<i>.
struct WrittenRobot {
  std::vector<WrittenLink> links;
  std::vector<std::size_t> joint_order;  ///< in which joints stand in the file
  std::vector<std::size_t> link_order;   ///< in which links stand in the file

  [[nodiscard]] std::string text() const;
  /// 4 x 4: coordinates of link `i` to coordinates of the root, all joints at zero, multiplied out
  /// from elementary rotations.
  [[nodiscard]] Eigen::Matrix4d pose(std::size_t i) const;
  /// The same of the collision body of link `i`, which has the frame of the link's inertia: a box
  /// of sides s, s + 1/4, s + 1/2, a cylinder of radius s and length s + 1/4 or a sphere of radius
  /// s, in turn, with s = 1 + i.
  [[nodiscard]] Eigen::Matrix4d collision_pose(std::size_t i) const;
  /// Moments of the links `which` about the origin of link `about`, summed over their points.
  [[nodiscard]] InertialParameters summed(const std::vector<std::size_t>& which,
                                          std::size_t about) const;
};

/// Four points in general position for each link; joints of all kinds, half of them fixed.
[[nodiscard]] rc::Gen<WrittenRobot> written_robot();

}  // namespace shapeid::test
