// The XML below the URDF reader: text to a checked document, attributes to numbers, every complaint
// with its line. Internal to models.
#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>

#include <optional>
#include <string>

#include "shapeid/models/error.hpp"

namespace shapeid::urdf {

/// 16 MiB: a hundred times the largest robot we know; beyond it something else was named.
inline constexpr std::size_t largest_file = std::size_t{1} << 24;
/// No length (m), mass (kg) or moment (kg m^2) of a robot is larger, and products of a few such
/// numbers stay finite.
inline constexpr double largest_number = 1e9;

/// Parses `text` and returns its only root element, which must be <robot>. Refuses what is not
/// well-formed, document type and entity declarations, repeated attributes, NUL bytes.
const tinyxml2::XMLElement& parse_robot(const std::string& text, const std::string& file,
                                        tinyxml2::XMLDocument& document);

/// Reads elements of one file; the file's name stands in every message.
class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] Place at(int line) const { return {file_, line, {}}; }

  /// The only child of that name, nullptr if there is none. Two are refused.
  const tinyxml2::XMLElement* child(const tinyxml2::XMLElement& element, const char* name) const;
  /// The same where the child must be there; `why` says what it is needed for.
  const tinyxml2::XMLElement& needed_child(const tinyxml2::XMLElement& element, const char* name,
                                           const char* why) const;

  /// A name: not empty, UTF-8, no blanks around it, no control characters.
  std::string name(const tinyxml2::XMLElement& element, const char* attribute) const;
  /// One number; a missing attribute is refused.
  double number(const tinyxml2::XMLElement& element, const char* attribute) const;
  /// One number or nothing, of any finite size (limits are often written as 1e16).
  std::optional<double> optional_number(const tinyxml2::XMLElement& element,
                                        const char* attribute) const;
  /// Three numbers between blanks; a missing attribute gives `otherwise`.
  Eigen::Vector3d three(const tinyxml2::XMLElement& element, const char* attribute,
                        const Eigen::Vector3d& otherwise) const;
  /// The pose of the child <origin xyz rpy>: roll about x, then pitch about y, then yaw about z of
  /// the parent's fixed axes. Identity without one.
  Eigen::Isometry3d origin(const tinyxml2::XMLElement& element) const;

 private:
  const tinyxml2::XMLAttribute& needed(const tinyxml2::XMLElement& element,
                                       const char* attribute) const;
  double bounded(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute& attribute,
                 std::string_view text) const;

  std::string file_;
};

}  // namespace shapeid::urdf
