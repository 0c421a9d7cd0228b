#include "shapeid/models/yaml_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>

#include "shapeid/models/number.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid {
namespace {

/// Our files are pages, not data: a thousand links with ten shapes each fit.
constexpr std::size_t largest_yaml = std::size_t{1} << 20;

/// YAML::Load() passes over what follows the first document. (YAML::LoadAll() takes all memory for
/// some texts that are none.)
void refuse_second_document(const std::string& text, const std::string& path) {
  std::istringstream lines(text);
  std::string line;
  bool begun = false;  // anything but comments, blanks and directives
  bool ended = false;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto is_marker = [&line](const char* three) {
      return line.starts_with(three) &&
             (line.size() == 3 || std::isspace(static_cast<unsigned char>(line[3])) != 0);
    };
    const auto first = line.find_first_not_of(" \t\r");
    const bool is_content = first != std::string::npos && line[first] != '#';
    if (is_marker("...")) {
      ended = begun;
      continue;
    }
    if (is_content && (ended || (is_marker("---") && begun))) {
      throw InputError({path, number, {}}, "a second document begins here", "one document a file");
    }
    begun = begun || (is_content && line[0] != '%');
  }
}

}  // namespace

YAML::Node load_yaml(const std::string& path) {
  try {
    const std::string text = read_small_file(path, largest_yaml);
    refuse_second_document(text, path);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError({path, error.mark.line + 1, {}}, "not YAML: " + error.msg, "write YAML");
  }
}

YamlInput::YamlInput(std::string path) : path_(std::move(path)), root_(load_yaml(path_)) {}

void YamlInput::refuse(const YAML::Node& node, const std::string& wrong,
                       const std::string& right) const {
  throw InputError(at(node), wrong, right);
}

std::vector<std::string> YamlInput::keys(const YAML::Node& node, const std::string& what) const {
  if (!node.IsMap()) refuse(node, what + " is not a map", "write lines of key: value");
  std::vector<std::string> result;
  std::set<std::string> seen;  // a megabyte of keys must not take a minute
  for (const auto& entry : node) {
    const std::string key = text(entry.first, "a key of " + what);
    if (!seen.insert(key).second) {
      refuse(entry.first, fmt::format("{} is named twice in {}", key, what), "name it once");
    }
    result.push_back(key);
  }
  return result;
}

void YamlInput::check_keys(const YAML::Node& node, const std::string& what,
                           const std::vector<std::string>& needed,
                           const std::vector<std::string>& optional) const {
  std::vector<std::string> known = needed;
  known.insert(known.end(), optional.begin(), optional.end());
  const std::vector<std::string> found = keys(node, what);
  for (const auto& entry : node) {
    if (std::find(known.begin(), known.end(), entry.first.Scalar()) == known.end()) {
      refuse(entry.first, fmt::format("{} has no key {}", what, entry.first.Scalar()),
             fmt::format("it has {}", fmt::join(known, ", ")));
    }
  }
  for (const std::string& key : needed) {
    if (std::find(found.begin(), found.end(), key) == found.end()) {
      refuse(node, fmt::format("{} does not give its {}", what, key),
             fmt::format("it needs {}", fmt::join(needed, ", ")));
    }
  }
}

std::string YamlInput::text(const YAML::Node& node, const std::string& what) const {
  if (!node.IsScalar()) refuse(node, what + " is not a word", "write one word");
  if (const Violation why = why_no_name(node.Scalar())) {
    refuse(node, fmt::format("{} {}", what, *why), "write one word");
  }
  return node.Scalar();
}

double YamlInput::number(const YAML::Node& node, const std::string& what) const {
  if (!node.IsScalar()) refuse(node, what + " is not a number", "write a decimal number");
  const std::optional<double> value = parse_number(node.Scalar());
  if (!value) {
    refuse(node, fmt::format("{} {}", what, why_no_number(node.Scalar())),
           "write a finite decimal number");
  }
  return *value;
}

double YamlInput::positive(const YAML::Node& node, const std::string& what) const {
  const double value = number(node, what);
  if (value <= 0.0) refuse(node, fmt::format("{} is {:g}", what, value), "it must be above zero");
  return value;
}

Eigen::VectorXd YamlInput::numbers(const YAML::Node& node, const std::string& what,
                                   Eigen::Index count) const {
  if (!node.IsSequence() || node.size() != static_cast<std::size_t>(count)) {
    refuse(node, fmt::format("{} is not a list of {} numbers", what, count),
           "write them in brackets, with commas between them");
  }
  Eigen::VectorXd result(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    result[i] = number(node[static_cast<std::size_t>(i)], what);
  }
  return result;
}

Eigen::Vector3d YamlInput::three(const YAML::Node& node, const std::string& what) const {
  return numbers(node, what, 3);
}

Eigen::Vector3d YamlInput::place(const YAML::Node& node, const std::string& what) const {
  constexpr double furthest = 1e6;  // m
  const Eigen::Vector3d result = three(node, what);
  if (result.cwiseAbs().maxCoeff() > furthest) {
    refuse(node, fmt::format("{} is {:g} m away", what, result.norm()), "metres, on the robot");
  }
  return result;
}

Eigen::Isometry3d YamlInput::pose(const YAML::Node& node, const std::string& what) const {
  check_keys(node, what, {}, {"xyz", "rpy"});
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  if (node["xyz"]) result.translation() = place(node["xyz"], what + " xyz");
  if (node["rpy"]) {
    const Eigen::Vector3d rpy = three(node["rpy"], what + " rpy");
    if (rpy.cwiseAbs().maxCoeff() > largest_angle) {
      refuse(node["rpy"], fmt::format("{} rpy turns by {:g}", what, rpy.cwiseAbs().maxCoeff()),
             "radians, a turn at most");
    }
    result.linear() = rotation_from_rpy(rpy);
  }
  return result;
}

}  // namespace shapeid
