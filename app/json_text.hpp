// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace shapeid::app {

/// `indent` < 0: on one line. Names of files are any bytes: what is no UTF-8 in them is replaced.
inline std::string json_text(const nlohmann::json& document, int indent) {
  return document.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace shapeid::app
