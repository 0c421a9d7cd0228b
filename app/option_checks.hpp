// What numbers among the options must be, refused in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shapeid::app {

/// A finite number within these bounds, in words with its unit.
[[nodiscard]] CLI::Validator number_from(double lower, double upper, const std::string& unit = "");
/// A whole number within these bounds; what fits, where there is no upper one.
[[nodiscard]] CLI::Validator count_from(
    std::uint64_t lowest, std::uint64_t highest = std::numeric_limits<std::uint64_t>::max());
/// A finite number above zero.
[[nodiscard]] CLI::Validator above_zero();
/// A finite number, zero or above.
[[nodiscard]] CLI::Validator zero_or_above();
/// k1 and k2 of (16), whose sum is a number.
[[nodiscard]] CLI::Validator weight_of_criterion();
/// A finite number above zero, at most one.
[[nodiscard]] CLI::Validator share_above_zero();
/// A mass of robots and of what they carry, kg.
[[nodiscard]] CLI::Validator mass_of_a_robot();
/// Samples a second of logs.
[[nodiscard]] CLI::Validator rate_of_a_log();

/// Places of two paths that name one file, or files of the same bytes, the second as far in front
/// as can be. A file that cannot be opened is said when it is read.
[[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> same_file(
    const std::vector<std::string>& paths);

/// Values of all options are looked at before the parser of the command line converts them: what
/// it would say of one that it cannot convert, or of an option given twice, lacks what is right.
void check_values_first(CLI::App& app);

/// What was given to a verb, before it begins. Throws InputError for an empty value, for a number
/// that is none, for a file to write that is read, and for a folder where a file is to be written.
void check_given(const CLI::App& verb);

}  // namespace shapeid::app
