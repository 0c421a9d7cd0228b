// Numbers in text, matched in full.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shapeid {

/// The finite number that the whole text spells (blanks around it and a leading plus are allowed);
/// empty for anything else: "nan", "inf", "1abc", "1,5", "1e999", "".
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// What is wrong with a text that parse_number refuses, as a clause without a subject.
[[nodiscard]] std::string why_no_number(std::string_view text);

/// The parts of a text between blanks (space, tab, line ends).
[[nodiscard]] std::vector<std::string_view> split_at_blanks(std::string_view text);

}  // namespace shapeid
