// A load's mass, place and inertia, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "shapeid/app/result.hpp"

namespace shapeid::app {

/// The same load behind another filter, which leaves more of the motion's peaks and noise.
struct LoadElsewhere {
  double cutoff = 0.0, row_cutoff = 0.0;  ///< Hz
  double mass = 0.0, error = 0.0;         ///< kg: the load's, and its standard error
};

/// A note if the two masses differ by more than their standard errors say; empty else.
[[nodiscard]] std::string filter_note(const Result& result, const LoadElsewhere& other);

/// mass (kg), centre (m, link frame), tensor about the centre (kg m^2: Ixx Ixy Ixz Iyy Iyz Izz).
[[nodiscard]] nlohmann::json load_json(const Result& result, const Robot& robot,
                                       const std::optional<LoadElsewhere>& other);
[[nodiscard]] std::string load_text(const Result& result, const Robot& robot);

}  // namespace shapeid::app
