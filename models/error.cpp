#include "shapeid/models/error.hpp"

#include <fmt/format.h>

#include <utility>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/text.hpp"

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

namespace {

// Bytes of a part of a message: lists of keys fit, whole files do not.
constexpr std::size_t longest_part = 600;

std::string joined(const std::string& wrong, const std::string& right) {
  return fmt::format("{}; {}", one_line(wrong, longest_part), one_line(right, longest_part));
}

}  // namespace

InputError::InputError(const Place& place, const std::string& wrong, const std::string& right)
    : std::runtime_error(
          fmt::format("{}: {}", one_line(describe(place), longest_part), joined(wrong, right))) {}

InputError::InputError(const std::string& wrong, const std::string& right)
    : std::runtime_error(joined(wrong, right)) {}

Refusal::Refusal(std::string code, const std::string& reason)
    : std::runtime_error(fmt::format("refused ({}): {}", code, reason)),
      code_(std::move(code)),
      reason_(reason) {}

}  // namespace shapeid
