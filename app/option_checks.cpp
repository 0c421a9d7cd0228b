#include "shapeid/app/option_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/number.hpp"

namespace shapeid::app {
namespace {

CLI::Validator number_that(const std::function<bool(double)>& is_right, const std::string& right) {
  return {[=](const std::string& text) -> std::string {
            const std::optional<double> number = parse_number(text);
            if (!number) return fmt::format("{}; must be {}", why_no_number(text), right);
            return is_right(*number) ? std::string()
                                     : fmt::format("is {}; must be {}", text, right);
          },
          "NUMBER " + right};
}

/// A count, without a sign, that fits.
bool is_count(const std::string& text, std::uint64_t& count) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, count);
  return error == std::errc() && stop == end;
}

/// 0x10, 0b10 and 0o10, the first of which CLI11 would read.
bool is_other_base(const std::string& text) {
  const std::size_t first = text.find_first_not_of("+-");
  return first != std::string::npos && text.size() > first + 1 && text[first] == '0' &&
         std::isalpha(static_cast<unsigned char>(text[first + 1])) != 0;
}

}  // namespace

CLI::Validator number_from(double lower, double upper, const std::string& unit) {
  const std::string right = fmt::format("from {} to {}", lower, upper);
  return number_that([=](double x) { return x >= lower && x <= upper; },
                     unit.empty() ? right : right + " " + unit);
}

CLI::Validator count_from(std::uint64_t lowest, std::uint64_t highest) {
  const bool is_open = highest == std::numeric_limits<std::uint64_t>::max();
  const std::string bounds = is_open ? fmt::format(", {} or more", lowest)
                                     : fmt::format(" from {} to {}", lowest, highest);
  const auto why_not = [=](const std::string& given) -> std::string {
    const std::string text = given.starts_with('+') ? given.substr(1) : given;
    std::uint64_t count = 0;
    if (is_other_base(text)) return {};  // which check_value() says
    if (is_count(text, count) && count >= lowest && count <= highest) return {};
    const std::string right = "must be a whole number" + bounds;
    if (text.empty()) return "is empty; " + right;
    const bool is_digits =
        std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
    const bool overflows = is_digits && !is_count(text, count);
    return fmt::format("is \"{}\"{}; {}", given, overflows ? ", which is too large" : "", right);
  };
  return {why_not, "COUNT" + bounds};
}

CLI::Validator above_zero() {
  return number_that([](double x) { return x > 0.0; }, "above 0");
}

CLI::Validator zero_or_above() {
  return number_that([](double x) { return x >= 0.0; }, "at least 0");
}

CLI::Validator weight_of_criterion() {
  return number_that([](double x) { return x >= 0.0 && x <= 1e100; }, "from 0 to 1e100");
}

CLI::Validator share_above_zero() {
  return number_that([](double x) { return x > 0.0 && x <= 1.0; }, "above 0 and at most 1");
}

CLI::Validator mass_of_a_robot() {
  return number_that([](double x) { return x >= 1e-6 && x <= 1e6; }, "from 1e-6 to 1e6 kg");
}

CLI::Validator rate_of_a_log() {
  return number_that([](double x) { return x >= 1.0 && x <= 2e4; }, "from 1 to 20000 Hz");
}

namespace {

bool is_whole_number(const std::string& text) {
  std::int64_t number = 0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end;
}

/// CLI11 takes leading zeros for that.
bool is_octal(const std::string& text) {
  const std::size_t first = text.find_first_not_of("+-");
  return first != std::string::npos && text.size() > first + 1 && text[first] == '0';
}

void check_value(const CLI::Option& option, const std::string& value) {
  const std::string name = option.get_name(), type = option.get_type_name();
  if (value.empty()) {
    throw InputError(name + " is empty", "give a value, or leave the option out");
  }
  if (type.starts_with("FLOAT") && !parse_number(value)) {
    throw InputError(name + " " + why_no_number(value), "give a finite decimal number");
  }
  const bool is_whole = type.starts_with("UINT") || type.starts_with("INT");
  if (is_whole && is_other_base(value)) {
    throw InputError(fmt::format("{} is \"{}\", which is no decimal number", name, value),
                     "give a decimal count");
  }
  if (type.starts_with("INT") && !is_whole_number(value)) {
    throw InputError(fmt::format("{} is \"{}\"", name, value), "give a whole number");
  }
  std::uint64_t count = 0;
  if (type.starts_with("UINT") && !is_count(value, count)) {
    throw InputError(fmt::format("{} is \"{}\"", name, value),
                     "give a whole number without a sign");
  }
  if (is_whole && is_octal(value)) {
    throw InputError(fmt::format("{} is \"{}\", which some read as octal", name, value),
                     "give a decimal count without leading zeros");
  }
}

/// What a verb writes into the folder that --out names.
std::vector<std::string> written_into_folder(const CLI::App& verb) {
  if (verb.get_name() == "diagnose") {
    return {"identified.urdf", "effects.yaml", "predict_torque.hpp", "result.json", "report.html"};
  }
  return {"result.json", "problem.json", "answer.json", "certificate.json", "identified.urdf"};
}

/// Whether `path`, written to, would change what `input` names: the file, or one of `names` in the
/// folder.
bool writes_over(const std::filesystem::path& path, const std::vector<std::string>& names,
                 const std::filesystem::path& input) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(input, none)) return false;
  if (!std::filesystem::is_directory(path, none)) {
    return std::filesystem::equivalent(path, input, none);
  }
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::filesystem::equivalent(path / name, input, none);
  });
}

bool is_written(const CLI::Option& option) {
  return option.get_name() == "--out" || option.get_name() == "--checkpoint";
}

/// A set of files is written as a whole or not at all, and what prevents it is said before the
/// work.
void check_no_folder_in_the_way(const std::filesystem::path& folder,
                                const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::filesystem::path path = folder / name;
    std::error_code none;
    if (std::filesystem::is_directory(path, none)) {
      throw InputError({path.string()}, "is a folder, and a file of this name is to be written",
                       "another folder for all of them");
    }
  }
}

bool have_same_bytes(const std::string& one, const std::string& other) {
  std::ifstream a(one, std::ios::binary), b(other, std::ios::binary);
  using Bytes = std::istreambuf_iterator<char>;
  return a && b && std::equal(Bytes(a), Bytes(), Bytes(b), Bytes());
}

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> same_file(
    const std::vector<std::string>& paths) {
  std::vector<std::uintmax_t> sizes;
  sizes.reserve(paths.size());
  std::error_code unknown;
  for (const std::string& path : paths) {
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    sizes.push_back(unknown ? 0 : size);
  }
  for (std::size_t second = 1; second < paths.size(); ++second) {
    for (std::size_t first = 0; first < second; ++first) {
      const bool alike = sizes[first] == sizes[second] && sizes[first] > 0;
      if (std::filesystem::equivalent(paths[second], paths[first], unknown) ||
          (alike && have_same_bytes(paths[first], paths[second]))) {
        return std::pair(first, second);
      }
    }
  }
  return std::nullopt;
}

void check_values_first(CLI::App& app) {
  std::vector<CLI::App*> verbs = app.get_subcommands({});
  if (verbs.empty()) verbs.push_back(&app);  // a program that is one
  for (CLI::App* verb : verbs) {
    for (CLI::Option* option : verb->get_options()) {
      if (option->get_type_size() == 0) continue;  // flags
      option->check([option](const std::string& value) {
        check_value(*option, value);
        return std::string();
      });
      // How often it was given is said by check_given(); the parser would not say what is right.
      if (option->get_items_expected_max() == 1) {
        option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
      }
    }
  }
}

void check_given(const CLI::App& verb) {
  const std::vector<const CLI::Option*> options = verb.get_options();
  for (const CLI::Option* option : options) {
    if (option->get_type_size() == 0) continue;  // flags
    if (option->get_items_expected_max() == 1 && option->count() > 1) {
      throw InputError(option->get_name() + " is given twice", "give it once");
    }
    for (const std::string& value : option->results()) check_value(*option, value);
  }
  const std::vector<std::string> names = written_into_folder(verb);
  for (const CLI::Option* out : options) {
    if (!is_written(*out) || out->count() == 0) continue;
    check_no_folder_in_the_way(out->results().front(), names);
    for (const CLI::Option* in : options) {
      if (is_written(*in)) continue;
      for (const std::string& input : in->results()) {
        if (!writes_over(out->results().front(), names, input)) continue;
        throw InputError({input}, "is read, and would be written over by " + out->get_name(),
                         "another place for what is written");
      }
    }
  }
}

}  // namespace shapeid::app
