// A load's mass, place and inertia, as JSON and as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/app/result.hpp"

namespace shapeid::app {

/// mass (kg), centre (m, link frame), tensor about the centre (kg m^2: Ixx Ixy Ixz Iyy Iyz Izz).
[[nodiscard]] nlohmann::json load_json(const Result& result, const Robot& robot);
[[nodiscard]] std::string load_text(const Result& result, const Robot& robot);

}  // namespace shapeid::app
