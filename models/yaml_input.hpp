// Strict reading of our own YAML files: unknown and repeated keys are refused, numbers are matched
// in full, every complaint has its line. Internal to models.
#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>

#include <string>
#include <vector>

#include "shapeid/models/error.hpp"

namespace shapeid {

/// The file's root node. Throws InputError if it cannot be read, is no YAML, or is larger than 1
/// MiB.
[[nodiscard]] YAML::Node load_yaml(const std::string& path);

class YamlInput {
 public:
  /// Throws InputError as load_yaml() does.
  explicit YamlInput(std::string path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const YAML::Node& root() const { return root_; }
  [[nodiscard]] Place at(const YAML::Node& node) const { return {path_, node.Mark().line + 1, {}}; }
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& wrong,
                           const std::string& right) const;

  /// The keys of a map in the file's order; `what` names the map in complaints.
  [[nodiscard]] std::vector<std::string> keys(const YAML::Node& node,
                                              const std::string& what) const;
  /// The same where only some keys are known, and the needed ones must be there.
  void check_keys(const YAML::Node& node, const std::string& what,
                  const std::vector<std::string>& needed,
                  const std::vector<std::string>& optional) const;

  [[nodiscard]] std::string text(const YAML::Node& node, const std::string& what) const;
  [[nodiscard]] double number(const YAML::Node& node, const std::string& what) const;
  [[nodiscard]] double positive(const YAML::Node& node, const std::string& what) const;
  /// A list of exactly `count` numbers.
  [[nodiscard]] Eigen::VectorXd numbers(const YAML::Node& node, const std::string& what,
                                        Eigen::Index count) const;
  [[nodiscard]] Eigen::Vector3d three(const YAML::Node& node, const std::string& what) const;
  /// A place within a thousand kilometres, m.
  [[nodiscard]] Eigen::Vector3d place(const YAML::Node& node, const std::string& what) const;
  /// {xyz, rpy}, both optional: m and rad, roll about x, then pitch about y, then yaw about z.
  [[nodiscard]] Eigen::Isometry3d pose(const YAML::Node& node, const std::string& what) const;

 private:
  std::string path_;
  YAML::Node root_;
};

}  // namespace shapeid
