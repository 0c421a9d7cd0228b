// shapeid convert: inertial parameters from one library's order to another's.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "shapeid/app/tell.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/number.hpp"
#include "shapeid/models/orders.hpp"

namespace shapeid::app {
namespace {

struct ConvertArguments {
  std::string from, to;
  std::vector<std::string> numbers;
  bool json = false;
};

double parsed(const std::string& text) {
  if (const std::optional<double> value = parse_number(text)) return *value;
  throw InputError("a parameter " + why_no_number(text), "write decimals, such as -0.25");
}

/// More words than any order has are not waited for, nor longer ones than a number needs.
std::vector<std::string> words_of_standard_input() {
  constexpr std::size_t most = 64;
  constexpr int longest = 400;
  std::vector<std::string> words;
  for (std::string word; words.size() < most && std::cin >> std::setw(longest) >> word;) {
    if (std::ssize(word) == longest) {
      throw InputError({"standard input"}, "has a number of 400 digits and more",
                       "no double has more than 17 that count");
    }
    words.push_back(word);
  }
  if (words.size() == most) {
    throw InputError({"standard input"}, fmt::format("has {} numbers and more", most),
                     "those of one body");
  }
  return words;
}

void convert(const ConvertArguments& options) {
  const Order from = order_named(options.from), to = order_named(options.to);
  const std::vector<std::string> words =
      options.numbers.empty() ? words_of_standard_input() : options.numbers;
  Eigen::VectorXd values(static_cast<Eigen::Index>(words.size()));
  for (std::size_t i = 0; i < words.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = parsed(words[i]);
  }
  const InertialParameters body = from_order(from, values);
  const Eigen::VectorXd result = to_order(to, body);
  constexpr double most = 1e100;  // products of two are numbers, too
  if (!(body.values.lpNorm<Eigen::Infinity>() < most && result.lpNorm<Eigen::Infinity>() < most)) {
    throw InputError(
        "these numbers are too large for a body, or do not fit into a double in another order",
        "kg, m and kg m^2 of a body");
  }
  if (const Violation why = why_impossible(body)) {
    tell(fmt::format("warning: no body can have these parameters: {}\n", *why));
  }
  if (options.json) {
    const nlohmann::json document = {{"order", options.to},
                                     {"numbers", std::vector<double>(result.begin(), result.end())},
                                     {"possible", !why_impossible(body)}};
    fmt::print("{}\n", document.dump());
  } else {
    fmt::print("{}\n", fmt::join(result.begin(), result.end(), " "));
  }
}

}  // namespace

void add_convert(CLI::App& app) {
  const auto options = std::make_shared<ConvertArguments>();
  CLI::App* verb = app.add_subcommand("convert", "inertial parameters from order to order");
  std::string names;
  for (const auto name : order_names) names += (names.empty() ? "" : ", ") + std::string(name);
  verb->add_option("--from", options->from, names)->required();
  verb->add_option("--to", options->to, names)->required();
  verb->add_option("numbers", options->numbers, "the parameters (default: from standard input)");
  verb->add_flag("--json", options->json, "print JSON");
  verb->callback([options] { convert(*options); });
}

}  // namespace shapeid::app
