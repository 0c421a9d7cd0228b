#include "shapeid/models/number.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace shapeid {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

struct Parsed {
  double value = 0.0;
  std::errc error{};
  bool complete = false;
};

Parsed parse(std::string_view text) {
  text = trimmed(text);
  // from_chars knows no plus sign; "+-1" must not slip through by taking it away.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Parsed result;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, result.value);
  result.error = error;
  result.complete = stop == end;
  return result;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const Parsed parsed = parse(text);
  if (parsed.error != std::errc{} || !parsed.complete || !std::isfinite(parsed.value)) return {};
  return parsed.value;
}

std::string why_no_number(std::string_view text) {
  if (trimmed(text).empty()) return "is empty";
  if (text.find("${") != std::string_view::npos) {
    return fmt::format("is a xacro expression (\"{}\"); expand the file first", text);
  }
  const Parsed parsed = parse(text);
  if (parsed.complete && parsed.error == std::errc::result_out_of_range) {
    return fmt::format("does not fit into a double (\"{}\")", text);
  }
  if (parsed.complete && parsed.error == std::errc{}) {
    return fmt::format("is not a finite number (\"{}\")", text);
  }
  if (text.find(',') != std::string_view::npos) {
    return fmt::format("is not a number (\"{}\": decimals take a point, not a comma)", text);
  }
  return fmt::format("is not a number (\"{}\")", text);
}

std::vector<std::string_view> split_at_blanks(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = text.find_first_not_of(blanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return parts;
}

}  // namespace shapeid
