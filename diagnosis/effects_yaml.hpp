// effects.yaml: effects with their numbers, written by diagnose and read by identify
// (docs/formats/effects-yaml.md).
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

[[nodiscard]] std::string write_effects_yaml(const Robot& robot,
                                             const std::vector<AppliedEffect>& effects);

/// Throws InputError for effects, places or parameters that do not exist, and for numbers that are
/// missing.
[[nodiscard]] std::vector<AppliedEffect> read_effects_yaml(const std::string& path,
                                                           const Robot& robot);

}  // namespace shapeid::diagnosis
