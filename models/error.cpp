#include "shapeid/models/error.hpp"

#include <fmt/format.h>

#include <utility>

#include "shapeid/models/contract.hpp"

namespace shapeid {

void demand(const Violation& violation, const char* file, int line) {
  if (violation) throw Defect(fmt::format("{}:{}: contract broken: {}", file, line, *violation));
}

std::string describe(const Place& place) {
  std::string text = place.file;
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (!place.column.empty()) text += fmt::format(", column {}", place.column);
  return text;
}

InputError::InputError(const Place& place, const std::string& wrong, const std::string& right)
    : std::runtime_error(fmt::format("{}: {}; {}", describe(place), wrong, right)) {}

InputError::InputError(const std::string& wrong, const std::string& right)
    : std::runtime_error(fmt::format("{}; {}", wrong, right)) {}

Refusal::Refusal(std::string code, const std::string& reason)
    : std::runtime_error(fmt::format("refused ({}): {}", code, reason)), code_(std::move(code)) {}

}  // namespace shapeid
