// The divisions of a run, one by one: the objective, and how far it still is above what infinitely
// many divisions could reach.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "shapeid/reference/identify.hpp"

namespace shapeid::app {

/// `floor`: proved; empty: none was. A list for result.json.
[[nodiscard]] nlohmann::json history_json(const reference::DivisionRun& run,
                                          const std::optional<double>& floor);

/// A line for the shapes as given and one a division; empty without divisions and floor.
[[nodiscard]] std::string history_text(const reference::Identification& found,
                                       const std::optional<double>& floor);

}  // namespace shapeid::app
