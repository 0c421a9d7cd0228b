#include "shapeid/diagnosis/effects_yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid::diagnosis {
namespace {

/// Shape numbers first, then parameters, by name.
std::vector<std::string> number_names(const Effect& effect) {
  std::vector<std::string> names;
  for (const ShapeNumber& s : effect.shape) names.push_back(s.name);
  for (const Parameter& p : effect.parameters) names.push_back(p.name);
  return names;
}

std::optional<int> find_site(const Robot& robot, const Effect& effect, const std::string& name) {
  for (int site = 0; site < site_count(robot, effect.site); ++site) {
    const bool exists = effect.applies == nullptr || effect.applies(robot, site);
    if (exists && site_name(robot, effect.site, site) == name) return site;
  }
  return std::nullopt;
}

AppliedEffect read_entry(const YamlInput& file, const YAML::Node& node, const Robot& robot) {
  file.check_keys(node, "an effect", {"effect", "site", "values"}, {});
  const std::string id = file.text(node["effect"], "effect");
  const Effect* effect = find_effect(id);
  if (effect == nullptr) {
    file.refuse(node["effect"], "there is no effect " + id, "shapeid diagnose --list names them");
  }
  const std::string place = file.text(node["site"], "site");
  const std::optional<int> site = find_site(robot, *effect, place);
  if (!site) {
    file.refuse(node["site"], fmt::format("{} has no place {} on this robot", id, place),
                "name a joint or link of the URDF, a contact, base.accel or all");
  }
  AppliedEffect applied = at_start(*effect, *site);
  const std::vector<std::string> names = number_names(*effect);
  file.check_keys(node["values"], "values", names, {});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value = file.number(node["values"][names[i]], names[i]);
    const auto at = static_cast<Eigen::Index>(i);
    (at < applied.shape.size() ? applied.shape[at] : applied.value[at - applied.shape.size()]) =
        value;
  }
  return applied;
}

}  // namespace

std::string write_effects_yaml(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::string text = effects.empty() ? "effects: []\n" : "effects:\n";
  for (const AppliedEffect& a : effects) {
    text += fmt::format("  - effect: {}\n    site: {}\n    values: {{", a.effect->id,
                        site_name(robot, a.effect->site, a.site));
    const std::vector<std::string> names = number_names(*a.effect);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double value = at < a.shape.size() ? a.shape[at] : a.value[at - a.shape.size()];
      text += fmt::format("{}{}: {}", i == 0 ? "" : ", ", names[i], value);
    }
    text += "}\n";
  }
  return text;
}

std::vector<AppliedEffect> read_effects_yaml(const std::string& path, const Robot& robot) {
  const YamlInput file(path);
  file.check_keys(file.root(), "the file", {"effects"}, {});
  const YAML::Node list = file.root()["effects"];
  if (!list.IsSequence()) file.refuse(list, "effects is no list", "give a list of effects");
  std::vector<AppliedEffect> effects;
  for (const YAML::Node& node : list) effects.push_back(read_entry(file, node, robot));
  return effects;
}

}  // namespace shapeid::diagnosis
