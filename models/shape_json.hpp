// Shapes as docs/formats/problem.md writes them down.
#pragma once

#include <nlohmann/json.hpp>

#include "shapeid/models/shape.hpp"
#include "shapeid/models/strict_json.hpp"

namespace shapeid {

[[nodiscard]] nlohmann::json shape_json(const Shape& shape);

/// `key` stands in messages. Throws InputError for anything that is no well-formed shape.
[[nodiscard]] Shape shape_from_json(const nlohmann::json& value, const std::string& key,
                                    const JsonSource& source);

}  // namespace shapeid
