// A URDF as written, link by link and joint by joint: numbers checked, references not yet resolved.
// Internal to models.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"

namespace shapeid::urdf {

/// An <inertial> as written.
struct Inertial {
  int line = 0;
  double mass = 0.0;
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< inertial frame in the link frame
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();  ///< about the centre of mass, inertial axes
  /// Half a unit of the last digit written of Ixx, Iyy, Izz (kg m^2): how far rounding may have
  /// moved each. Zero for a number without decimals.
  std::array<double, 3> rounding = {0.0, 0.0, 0.0};

  /// About the link's origin in link axes.
  [[nodiscard]] InertialParameters parameters() const;
};

struct DocumentLink {
  std::string name;
  int line = 0;
  std::optional<Inertial> inertial;
  std::vector<CollisionBody> collision;  ///< in the link's own frame
};

enum class DocumentJointType { fixed, revolute, continuous, prismatic, floating };

struct Mimic {
  std::string joint;
  double multiplier = 1.0, offset = 0.0;
};

struct DocumentJoint {
  DocumentJointType type = DocumentJointType::fixed;
  std::string parent, child;
  int line = 0;
  std::optional<Mimic> mimic;
  Joint joint;  ///< name, placement, axis and limits; its kind counts for moving joints only
};

struct Document {
  std::string name;
  std::string file;
  std::vector<DocumentLink> links;
  std::vector<DocumentJoint> joints;
  std::vector<std::string> notes;
};

/// Throws InputError for a text that is no URDF or holds a malformed element.
[[nodiscard]] Document read_document(const std::string& text, const std::string& file);

}  // namespace shapeid::urdf
