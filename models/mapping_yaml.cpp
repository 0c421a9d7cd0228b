#include <fmt/format.h>

#include <cmath>
#include <set>

#include "shapeid/models/log.hpp"
#include "shapeid/models/lower_case.hpp"
#include "shapeid/models/number.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid {
namespace {

void read_numbers(const YamlInput& file, const YAML::Node& node, const std::string& what,
                  std::map<std::string, double>& values, std::map<std::string, int>& lines) {
  static_cast<void>(file.keys(node, what));  // a map, and no key twice
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    values[key] = file.number(entry.second, key);
    lines[key] = file.at(entry.first).line;
  }
}

int line_of(const std::map<std::string, int>& lines, const std::string& key) {
  const auto found = lines.find(key);
  return found == lines.end() ? 0 : found->second;
}

/// `hold: true` is a group of its own, `hold: name` shares one.
std::string read_hold(const YamlInput& file, const YAML::Node& node, const ColumnRule& rule) {
  std::string word = file.text(node, "hold");
  if (word == "true") return rule.from;
  if (word == "false") return "";
  // YAML has had many spellings of these; as a name none of them is meant.
  static const std::set<std::string> spellings = {"true", "false", "yes", "no", "on", "off"};
  if (spellings.contains(lower_case(word)) || parse_number(word)) {
    file.refuse(node, fmt::format("hold is {}", word),
                "write true, false, or a name that columns which are read at once share");
  }
  return word;
}

ColumnRule read_rule(const YamlInput& file, const YAML::Node& node, const std::string& ours) {
  ColumnRule rule;
  if (node.IsScalar()) {
    rule.from = file.text(node, ours);
    return rule;
  }
  file.check_keys(node, ours, {"from"}, {"scale", "offset", "sign", "hold"});
  rule.from = file.text(node["from"], "from");
  if (node["scale"]) rule.scale = file.number(node["scale"], "scale");
  if (node["offset"]) rule.offset = file.number(node["offset"], "offset");
  if (node["sign"]) rule.sign = file.number(node["sign"], "sign");
  if (node["hold"]) rule.hold = read_hold(file, node["hold"], rule);
  if (rule.scale == 0.0) {
    file.refuse(node["scale"], "scale is zero", "leave the column out instead");
  }
  if (std::abs(rule.sign) != 1.0) {
    file.refuse(node["sign"], fmt::format("sign is {:g}", rule.sign),
                "write 1 or -1, and factors as scale");
  }
  return rule;
}

TorqueKind read_kind(const YamlInput& file, const YAML::Node& node) {
  const std::string kind = file.text(node, "kind");
  if (kind == "joint") return TorqueKind::joint;
  if (kind == "motor") return TorqueKind::motor;
  if (kind == "current") return TorqueKind::current;
  file.refuse(node, fmt::format("torque kind {} is not known", kind),
              "write joint, motor or current");
}

void read_torque(const YamlInput& file, const YAML::Node& node, Mapping& mapping) {
  file.check_keys(node, "torque", {"kind"}, {"factor"});
  mapping.torque = read_kind(file, node["kind"]);
  mapping.torque_line = file.at(node).line;
  if (node["factor"]) {
    read_numbers(file, node["factor"], "factor", mapping.torque_factor, mapping.factor_lines);
  }
  for (const auto& [joint, factor] : mapping.torque_factor) {
    if (factor != 0.0) continue;
    file.refuse(node["factor"][joint], fmt::format("the factor of {} is zero", joint),
                "a gear ratio (motor) or N m per A (current)");
  }
  const bool is_joint = mapping.torque == TorqueKind::joint;
  if (is_joint == mapping.torque_factor.empty()) return;
  if (is_joint) {
    file.refuse(node, "joint torque has factors",
                "leave them out, or say what they are of: kind: motor or current");
  }
  file.refuse(node, node["kind"].Scalar() + " torque has no factors",
              "give a gear ratio (motor) or N m per A (current) for every joint");
}

}  // namespace

Place Mapping::at_kept(const std::string& column) const {
  return {file, line_of(keep_lines, column)};
}

Place Mapping::at_factor(const std::string& joint) const {
  return {file, line_of(factor_lines, joint)};
}

Mapping read_mapping_yaml(const std::string& path) {
  const YamlInput file(path);
  const YAML::Node& root = file.root();
  file.check_keys(root, "the mapping", {}, {"columns", "keep_rows", "torque"});
  Mapping mapping;
  mapping.file = path;
  if (const YAML::Node columns = root["columns"]) {
    static_cast<void>(file.keys(columns, "columns"));
    for (const auto& entry : columns) {
      const std::string ours = entry.first.Scalar();
      ColumnRule& rule = mapping.columns[ours] = read_rule(file, entry.second, ours);
      rule.line = file.at(entry.first).line;
    }
  }
  if (const YAML::Node keep = root["keep_rows"]) {
    read_numbers(file, keep, "keep_rows", mapping.keep_rows, mapping.keep_lines);
  }
  if (const YAML::Node torque = root["torque"]) read_torque(file, torque, mapping);
  return mapping;
}

}  // namespace shapeid
