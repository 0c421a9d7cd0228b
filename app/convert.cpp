// shapeid convert: inertial parameters from one library's order to another's.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/orders.hpp"

namespace shapeid::app {
namespace {

struct Options {
  std::string from, to;
  std::vector<std::string> numbers;
  bool json = false;
};

double number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError("'" + text + "' is not a finite number", "write decimals, such as -0.25");
  }
  return value;
}

void convert(const Options& options) {
  const Order from = order_named(options.from), to = order_named(options.to);
  std::vector<std::string> words = options.numbers;
  if (words.empty()) {
    for (std::string word; std::cin >> word;) words.push_back(word);
  }
  Eigen::VectorXd values(static_cast<Eigen::Index>(words.size()));
  for (std::size_t i = 0; i < words.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = number(words[i]);
  }
  const InertialParameters body = from_order(from, values);
  const Eigen::VectorXd result = to_order(to, body);
  if (!body.values.allFinite() || !result.allFinite()) {
    throw InputError("these numbers do not fit into a double in another order",
                     "kg, m and kg m^2 of a body");
  }
  if (const Violation why = why_impossible(body)) {
    fmt::print(stderr, "warning: no body can have these parameters: {}\n", *why);
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
  const auto options = std::make_shared<Options>();
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
