#include "shapeid/diagnosis/effects_yaml.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/models/inertia.hpp"
#include "shapeid/models/yaml_input.hpp"

namespace shapeid::diagnosis {
namespace {

/// No torque (N m), force (N), mass (kg) or coefficient of a robot is larger: beyond it a unit or
/// an exponent is wrong, and what would be said of the log instead would blame the log.
constexpr double largest_number = 1e6;

/// A name as YAML reads it back, in quotes where it needs them.
std::string scalar(const std::string& name) {
  YAML::Emitter text;
  text << name;
  return text.c_str();
}

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

/// An effect at a place, its numbers at their start.
AppliedEffect read_place(const YamlInput& file, const YAML::Node& node, const Robot& robot) {
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
  return at_start(*effect, *site);
}

/// A ratio has the unit "1", which is not said.
std::string behind_number(const std::string& unit) { return unit == "1" ? "" : " " + unit; }

std::string bounds_text(double least, double most, const std::string& unit) {
  return fmt::format("{:g} to {:g}{}", least, most, behind_number(unit));
}

/// What is known may lie beyond where it is sought (friction of a Franka Panda is published with a
/// width of 0.39 rad/s); what lies far beyond is a unit gone wrong.
void check_shape(const YamlInput& file, const YAML::Node& node, const ShapeNumber& shape,
                 double value) {
  constexpr double beyond = 10.0;
  const double least = shape.lower / beyond, most = shape.upper * beyond;
  if (value >= least && value <= most) return;
  file.refuse(node, fmt::format("{} is {:g}", shape.name, value),
              bounds_text(least, most, shape.unit));
}

/// Limits of columns are of what is believed when they are sought; a number that is known may be
/// any that a robot can have. A transformation works within its limits alone.
void check_value(const YamlInput& file, const YAML::Node& node, const Effect& effect,
                 const Parameter& parameter, double value) {
  const double limit =
      effect.transform.any() ? std::min(parameter.limit, largest_number) : largest_number;
  const double least = parameter.nonnegative ? 0.0 : -limit;
  if (value >= least && value <= limit) return;
  const bool is_negative = value < least && parameter.nonnegative && !effect.transform.any();
  file.refuse(node, fmt::format("{} is {:g}", parameter.name, value),
              is_negative ? "at least 0" + behind_number(parameter.unit)
                          : bounds_text(least, limit, parameter.unit));
}

AppliedEffect read_entry(const YamlInput& file, const YAML::Node& node, const Robot& robot) {
  file.check_keys(node, "an effect", {"effect", "site", "values"}, {"since_reference"});
  AppliedEffect applied = read_place(file, node, robot);
  if (const YAML::Node since = node["since_reference"]) {
    bool has_come = false;
    if (!YAML::convert<bool>::decode(since, has_come)) {
      file.refuse(since, "since_reference is neither true nor false", "give one of these");
    }
    if (has_come) applied.when = When::since_reference;
  }
  const std::vector<std::string> names = number_names(*applied.effect);
  file.check_keys(node["values"], "values", names, {});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const YAML::Node number = node["values"][names[i]];
    const double value = file.number(number, names[i]);
    const std::size_t shapes = applied.effect->shape.size();
    if (i < shapes) {
      check_shape(file, number, applied.effect->shape[i], value);
      applied.shape[static_cast<Eigen::Index>(i)] = value;
    } else {
      check_value(file, number, *applied.effect, applied.effect->parameters[i - shapes], value);
      applied.value[static_cast<Eigen::Index>(i - shapes)] = value;
    }
  }
  if (!applied.effect->is_payload) return applied;
  // Numbers that somebody typed have a few digits.
  constexpr double written = 1e-6;
  if (const Violation reason = why_impossible({applied.value.head<10>()}, written)) {
    file.refuse(node["values"], *reason,
                "moments of a body that can exist, about the link's origin");
  }
  return applied;
}

Eigen::VectorXd read_numbers(const YamlInput& file, const YAML::Node& node,
                             const std::string& what) {
  return file.numbers(node, what, node.IsSequence() ? static_cast<Eigen::Index>(node.size()) : 2);
}

Curve read_curve(const YamlInput& file, const YAML::Node& node, const Robot& robot) {
  file.check_keys(node, "a curve", {"effect", "site", "over", "at", "number"}, {"shape"});
  Curve curve;
  curve.law = read_place(file, node, robot);
  const Effect& law = *curve.law.effect;
  if (!can_follow(law)) {
    file.refuse(node["effect"], law.id + " cannot follow a signal",
                "give a law of one column at a joint, such as torque_offset");
  }
  std::vector<std::string> names;
  for (const ShapeNumber& s : law.shape) names.push_back(s.name);
  if (!names.empty() && !node["shape"]) {
    file.refuse(node, law.id + " has no shape here",
                fmt::format("give {}", fmt::join(names, ", ")));
  }
  if (node["shape"]) file.check_keys(node["shape"], "shape", names, {});
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double value = file.number(node["shape"][names[i]], names[i]);
    check_shape(file, node["shape"][names[i]], law.shape[i], value);
    curve.law.shape[static_cast<Eigen::Index>(i)] = value;
  }
  const std::string name = file.text(node["over"], "over");
  const std::optional<CurveVariable> over = find_variable(name, robot);
  if (!over) {
    file.refuse(node["over"], "there is no signal " + name,
                "give q., dq., ddq. or tau. and a joint of the URDF");
  }
  curve.over = *over;
  curve.at = read_numbers(file, node["at"], "at");
  curve.number = read_numbers(file, node["number"], "number");
  const bool increase = std::adjacent_find(curve.at.begin(), curve.at.end(),
                                           std::greater_equal<>()) == curve.at.end();
  if (curve.at.size() < 2 || !increase) {
    file.refuse(node["at"], "the knots do not increase",
                "give two or more numbers, each larger than the one before");
  }
  if (curve.number.size() > 0 && curve.number.cwiseAbs().maxCoeff() > largest_number) {
    file.refuse(node["number"], fmt::format("a number of {:g}", curve.number.cwiseAbs().maxCoeff()),
                bounds_text(-largest_number, largest_number, law.parameters.front().unit));
  }
  if (curve.number.size() != curve.at.size()) {
    file.refuse(node["number"],
                fmt::format("{} numbers for {} knots", curve.number.size(), curve.at.size()),
                "give one a knot");
  }
  return curve;
}

std::string curve_text(const Robot& robot, const Curve& curve) {
  const Effect& law = *curve.law.effect;
  std::string shape;
  for (std::size_t i = 0; i < law.shape.size(); ++i) {
    shape += fmt::format("{}{}: {}", i == 0 ? "" : ", ", law.shape[i].name,
                         curve.law.shape[static_cast<Eigen::Index>(i)]);
  }
  if (!shape.empty()) shape = fmt::format("    shape: {{{}}}\n", shape);
  return fmt::format(
      "  - effect: {}\n    site: {}\n{}    over: {}\n    at: [{}]\n    number: [{}]\n", law.id,
      scalar(site_name(robot, law.site, curve.law.site)), shape,
      scalar(variable_name(curve.over, robot)), fmt::join(curve.at, ", "),
      fmt::join(curve.number, ", "));
}

}  // namespace

std::string write_effects_yaml(const Robot& robot, const KnownEffects& known) {
  std::string text = known.effects.empty() ? "effects: []\n" : "effects:\n";
  for (const AppliedEffect& a : known.effects) {
    text += fmt::format("  - effect: {}\n    site: {}\n    values: {{", a.effect->id,
                        scalar(site_name(robot, a.effect->site, a.site)));
    const std::vector<std::string> names = number_names(*a.effect);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double value = at < a.shape.size() ? a.shape[at] : a.value[at - a.shape.size()];
      text += fmt::format("{}{}: {}", i == 0 ? "" : ", ", names[i], value);
    }
    text += "}\n";
    if (a.when == When::since_reference) text += "    since_reference: true\n";
  }
  if (!known.curves.empty()) text += "curves:\n";
  for (const Curve& curve : known.curves) text += curve_text(robot, curve);
  return text;
}

KnownEffects read_effects_yaml(const std::string& path, const Robot& robot) {
  const YamlInput file(path);
  file.check_keys(file.root(), "the file", {"effects"}, {"curves"});
  const YAML::Node list = file.root()["effects"];
  if (!list.IsSequence()) file.refuse(list, "effects is no list", "give a list of effects");
  KnownEffects known;
  for (const YAML::Node& node : list) {
    const AppliedEffect effect = read_entry(file, node, robot);
    if (has_place_of(known.effects, effect)) {
      file.refuse(node, fmt::format("{} is there already", hypothesis_id(robot, effect)),
                  "give one entry an effect and place");
    }
    known.effects.push_back(effect);
  }
  const YAML::Node curves = file.root()["curves"];
  if (!curves) return known;
  if (!curves.IsSequence()) file.refuse(curves, "curves is no list", "give a list of curves");
  for (const YAML::Node& node : curves) known.curves.push_back(read_curve(file, node, robot));
  return known;
}

}  // namespace shapeid::diagnosis
