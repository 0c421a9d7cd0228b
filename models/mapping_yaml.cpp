#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid {
namespace {

/// A node with the place to complain about.
struct Reader {
  std::string path;

  [[nodiscard]] Place place(const YAML::Node& node) const { return {path, node.Mark().line + 1}; }

  /// Throws unless `node` is a map whose keys are all different and, if `allowed` is given, known.
  void check_map(const YAML::Node& node, const std::string& what,
                 const std::set<std::string>& allowed) const {
    if (!node.IsMap()) throw InputError(place(node), what + " is not a map", "write key: value");
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string key = text(entry.first, "a key of " + what);
      if (!seen.insert(key).second) {
        throw InputError(place(entry.first), fmt::format("{} appears twice in {}", key, what),
                         "give every key once");
      }
      if (!allowed.empty() && !allowed.contains(key)) {
        throw InputError(place(entry.first), fmt::format("{} has no key {}", what, key),
                         fmt::format("the keys are {}", fmt::join(allowed, ", ")));
      }
    }
  }

  [[nodiscard]] std::string text(const YAML::Node& node, const std::string& what) const {
    if (!node.IsScalar() || node.Scalar().empty()) {
      throw InputError(place(node), what + " is no name", "write one word");
    }
    return node.Scalar();
  }

  [[nodiscard]] double number(const YAML::Node& node, const std::string& what) const {
    const std::string text = node.IsScalar() ? node.Scalar() : std::string();
    double value = 0.0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc() || stop != end || !std::isfinite(value)) {
      throw InputError(place(node), fmt::format("{} \"{}\" is not a number", what, text),
                       "write a decimal with a point");
    }
    return value;
  }

  [[nodiscard]] std::map<std::string, double> numbers(const YAML::Node& node,
                                                      const std::string& what) const {
    check_map(node, what, {});
    std::map<std::string, double> values;
    for (const auto& entry : node) {
      const std::string key = text(entry.first, "a key of " + what);
      values[key] = number(entry.second, key);
    }
    return values;
  }

  /// `hold: true` is a group of its own, `hold: name` shares one.
  [[nodiscard]] std::string hold(const YAML::Node& node, const ColumnRule& rule) const {
    const std::string word = text(node, "hold");
    if (word == "true") return rule.from;
    return word == "false" ? "" : word;
  }

  [[nodiscard]] ColumnRule rule(const YAML::Node& node, const std::string& ours) const {
    ColumnRule rule;
    if (node.IsScalar()) {
      rule.from = text(node, ours);
      return rule;
    }
    check_map(node, ours, {"from", "scale", "offset", "sign", "hold"});
    if (!node["from"]) {
      throw InputError(place(node), ours + " does not say from which column", "write from: COLUMN");
    }
    rule.from = text(node["from"], "from");
    if (node["scale"]) rule.scale = number(node["scale"], "scale");
    if (node["offset"]) rule.offset = number(node["offset"], "offset");
    if (node["sign"]) rule.sign = number(node["sign"], "sign");
    if (node["hold"]) rule.hold = hold(node["hold"], rule);
    if (rule.scale == 0.0) {
      throw InputError(place(node["scale"]), "scale is zero", "leave the column out instead");
    }
    if (std::abs(rule.sign) != 1.0) {
      throw InputError(place(node["sign"]), fmt::format("sign is {:g}", rule.sign),
                       "write 1 or -1, and factors as scale");
    }
    return rule;
  }

  void read_torque(const YAML::Node& node, Mapping& mapping) const {
    check_map(node, "torque", {"kind", "factor"});
    if (!node["kind"]) {
      throw InputError(place(node), "torque has no kind", "write kind: joint, motor or current");
    }
    const std::string kind = text(node["kind"], "kind");
    if (kind == "joint") {
      mapping.torque = TorqueKind::joint;
    } else if (kind == "motor") {
      mapping.torque = TorqueKind::motor;
    } else if (kind == "current") {
      mapping.torque = TorqueKind::current;
    } else {
      throw InputError(place(node["kind"]), fmt::format("torque kind {} is not known", kind),
                       "write joint, motor or current");
    }
    if (node["factor"]) mapping.torque_factor = numbers(node["factor"], "factor");
    if ((mapping.torque == TorqueKind::joint) != mapping.torque_factor.empty()) {
      throw InputError(place(node),
                       mapping.torque == TorqueKind::joint ? "joint torque has factors"
                                                           : kind + " torque has no factors",
                       "give a gear ratio (motor) or N m per A (current) for every joint");
    }
  }
};

}  // namespace

Mapping read_mapping_yaml(const std::string& path) {
  const Reader reader{path};
  const YAML::Node root = load_yaml(path);
  reader.check_map(root, "the mapping", {"columns", "keep_rows", "torque"});
  Mapping mapping;
  if (const YAML::Node columns = root["columns"]) {
    reader.check_map(columns, "columns", {});
    for (const auto& entry : columns) {
      const std::string ours = entry.first.Scalar();
      mapping.columns[ours] = reader.rule(entry.second, ours);
    }
  }
  if (const YAML::Node keep = root["keep_rows"]) {
    mapping.keep_rows = reader.numbers(keep, "keep_rows");
  }
  if (const YAML::Node torque = root["torque"]) reader.read_torque(torque, mapping);
  return mapping;
}

}  // namespace shapeid
