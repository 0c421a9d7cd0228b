// effects.yaml: effects with their numbers, and curves, written by diagnose and read by identify
// (docs/formats/effects-yaml.md).
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// What is known of a robot besides rigid links.
struct KnownEffects {
  std::vector<AppliedEffect> effects;
  std::vector<Curve> curves;
};

[[nodiscard]] std::string write_effects_yaml(const Robot& robot, const KnownEffects& known);

/// Throws InputError for effects, places, parameters or signals that do not exist, for numbers that
/// are missing, and for curves whose knots do not increase.
[[nodiscard]] KnownEffects read_effects_yaml(const std::string& path, const Robot& robot);

}  // namespace shapeid::diagnosis
