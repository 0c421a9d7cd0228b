// shapeid convert: inertial parameters from one library's order to another's.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

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

void convert(const ConvertArguments& options) {
  const Order from = order_named(options.from), to = order_named(options.to);
  std::vector<std::string> words = options.numbers;
  if (words.empty()) {
    for (std::string word; std::cin >> word;) words.push_back(word);
  }
  Eigen::VectorXd values(static_cast<Eigen::Index>(words.size()));
  for (std::size_t i = 0; i < words.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = parsed(words[i]);
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
