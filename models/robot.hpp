// A robot as a tree of rigid links, the way both paths see it: fixed joints already lumped.
#pragma once

#include <Eigen/Geometry>

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "shapeid/models/inertia.hpp"

namespace shapeid {

enum class JointKind { revolute, continuous, prismatic };

/// The joint that carries a link. The joint's frame is the child link's frame.
struct Joint {
  std::string name;
  JointKind kind = JointKind::revolute;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();  ///< child frame in parent at q = 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();              ///< unit vector, child frame
  double lower = -std::numeric_limits<double>::infinity();      ///< rad or m
  double upper = std::numeric_limits<double>::infinity();
  double effort = std::numeric_limits<double>::infinity();    ///< N m or N
  double velocity = std::numeric_limits<double>::infinity();  ///< rad/s or m/s
  /// kg m^2, or kg where it slides: of the drive's rotor, seen through its gear. It takes this
  /// times ddq of the drive's torque before the links see any.
  double rotor_inertia = 0.0;
};

/// The unit of a quantity at this joint, from that at one that turns: where it slides, N m is N,
/// rad is m, and kg m^2 is kg.
[[nodiscard]] std::string unit_at(const Joint& joint, std::string rotary);

struct Box {
  Eigen::Vector3d size;  ///< full side lengths, m
};
struct CylinderGeometry {
  double radius, length;  ///< m, axis z
};
struct SphereGeometry {
  double radius;  ///< m
};
struct MeshGeometry {
  std::string file;       ///< as written in the URDF
  Eigen::Vector3d scale;  ///< per axis
};

/// A collision body of the URDF, in the frame of the (lumped) link that carries it.
struct CollisionBody {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::variant<Box, CylinderGeometry, SphereGeometry, MeshGeometry> geometry;
};

/// A link of the URDF as written: its own name, inertia and frame, before lumping.
struct Member {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< its frame in the lumped link's frame
  bool has_inertial = false;
  InertialParameters inertia;  ///< about the lumped link's origin, in its axes
  int line = 0;                ///< where the link stands in the file
};

/// A rigid body of the tree: one URDF link and all that fixed joints tie to it.
struct Link {
  std::string name;            ///< the URDF link that a moving joint (or the root) carries
  int parent = -1;             ///< index of the parent link; -1 for the root
  Joint joint;                 ///< joint to the parent; meaningless for the root
  InertialParameters inertia;  ///< sum over the members, about this link's origin
  std::vector<Member> members;
  std::vector<CollisionBody> collision;
};

enum class ContactKind {
  point,  ///< three force components
  line,   ///< no moment about the line (the x axis of `frame`): five components
  plane   ///< a full wrench: six components
};

/// How many numbers the force of a contact of this kind has; as many rows has its Jacobian.
[[nodiscard]] constexpr Eigen::Index force_numbers(ContactKind kind) noexcept {
  switch (kind) {
    case ContactKind::point:
      return 3;
    case ContactKind::line:
      return 5;
    case ContactKind::plane:
      break;
  }
  return 6;
}

/// A place where the robot may touch the world.
struct Contact {
  std::string name;  ///< the URDF link that it belongs to, also when a fixed joint lumps it
  int link = 0;      ///< index of the lumped link
  ContactKind kind = ContactKind::point;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< in the lumped link's frame
};

/// A URDF link's place after lumping.
struct LinkSite {
  int link = 0;                                            ///< index in Robot::links
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< its frame in the lumped link's
};

enum class Root { fixed, floating };

/// Links stand parents first; link 0 is the root. Joint j moves link j + 1, and this is the
/// robot's order of joints everywhere. Generalised order: base linear, base angular (floating
/// root only), then joints.
struct Robot {
  std::string name;
  Root root = Root::floating;
  std::vector<Link> links;
  std::vector<Contact> contacts;
  std::vector<std::string> notes;  ///< what reading did that a reader should know, e.g. lumping

  [[nodiscard]] int link_count() const { return static_cast<int>(links.size()); }
  [[nodiscard]] int joint_count() const { return link_count() - 1; }
  [[nodiscard]] int base_dof() const { return root == Root::floating ? 6 : 0; }
  /// N_G: 6 + n for a floating root, n for a fixed one.
  [[nodiscard]] int dof() const { return base_dof() + joint_count(); }
  /// kg, of all links as given
  [[nodiscard]] double mass() const;
  [[nodiscard]] const Joint& joint(int j) const {
    return links[static_cast<std::size_t>(j) + 1].joint;
  }

  /// Where the URDF link `wanted` went; empty if there is none.
  [[nodiscard]] std::optional<LinkSite> find_site(const std::string& wanted) const;
  /// Index of the lumped link that the URDF link `wanted` belongs to; empty if there is none.
  [[nodiscard]] std::optional<int> find_link(const std::string& wanted) const;
  [[nodiscard]] std::optional<int> find_joint(const std::string& wanted) const;
};

/// Empty if indices, axes, poses and inertias are as promised above.
[[nodiscard]] Violation why_malformed(const Robot& robot);

/// The parameters of all links stacked, 10 per link.
[[nodiscard]] Eigen::VectorXd stacked_parameters(const Robot& robot);
/// Empty if `Phi` has ten for each link.
[[nodiscard]] Violation why_not_stacked(const Eigen::VectorXd& Phi, const Robot& robot);

}  // namespace shapeid
