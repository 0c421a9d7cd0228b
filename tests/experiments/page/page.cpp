#include "shapeid/tests/experiments/page/page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace shapeid::experiments {
namespace {

/// A number as written, or one of the findings; nothing if they have none of that name.
std::optional<double> operand(const Findings& findings, const std::string& word) {
  const auto found = findings.values.find(word);
  if (found != findings.values.end()) return found->second;
  try {
    std::size_t used = 0;
    const double number = std::stod(word, &used);
    if (used == word.size()) return number;
  } catch (const std::invalid_argument&) {
    // neither a name nor a number
  }
  return std::nullopt;
}

bool holds(double a, const std::string& sign, double b) {
  if (sign == "<") return a < b;
  if (sign == "<=") return a <= b;
  if (sign == "=") return a == b;
  throw std::invalid_argument("'" + sign + "' is none of <, <= and =");
}

std::string number(double x, const std::string& spec) {
  if (spec == "d") return fmt::format("{}", std::llround(x));
  if (spec == "%") return fmt::format("{:.3g}", 100.0 * x);
  return fmt::format(fmt::runtime("{:" + spec + "}"), x);
}

std::string markdown(const Table& table) {
  std::string text;
  for (const auto& row : table) {
    text += fmt::format("| {} |\n", fmt::join(row, " | "));
    if (&row != &table.front()) continue;
    text += "|";
    for (std::size_t i = 0; i < row.size(); ++i) text += "---|";
    text += "\n";
  }
  text.pop_back();  // the template has the line's end
  return text;
}

/// The statement's fault, if it has one.
std::optional<std::string> fault(const Findings& findings, const std::string& statement) {
  std::istringstream words(statement);
  std::string verb, left, sign, right;
  words >> verb >> left >> sign >> right;
  const auto a = operand(findings, left), b = operand(findings, right);
  if (!a || !b) return fmt::format("no number is called {}", a ? right : left);
  if (holds(*a, sign, *b)) return std::nullopt;
  return fmt::format("{} ({:g} and {:g})", statement, *a, *b);
}

}  // namespace

Page fill(const std::string& text, const Findings& findings,
          const std::map<std::string, std::string>& texts, const std::string& pictures) {
  Page page;
  const auto missing = [&page](const std::string& kind, const std::string& name) {
    page.broken.push_back(fmt::format("no {} is called {}", kind, name));
    return std::string("?");
  };
  std::size_t at = 0;
  for (std::size_t open = 0; (open = text.find('{', at)) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) throw std::invalid_argument("a brace is not closed");
    page.text += text.substr(at, open - at);
    at = close + 1;
    const std::string inside = text.substr(open + 1, close - open - 1);
    std::istringstream words(inside);
    std::string first, name;
    words >> first >> name;
    if (first == "table") {
      const auto table = findings.tables.find(name);
      page.text += table == findings.tables.end() ? missing(first, name) : markdown(table->second);
    } else if (first == "plot") {
      std::string title;
      std::getline(words >> std::ws, title);
      page.text += findings.plots.contains(name)
                       ? fmt::format("![{}]({}/{}.svg)", title, pictures, name)
                       : missing(first, name);
    } else if (first == "text") {
      page.text += texts.at(name);
    } else if (first == "holds") {
      if (const auto found = fault(findings, inside)) page.broken.push_back(*found);
      // The statement leaves no space at a line's end, and no line of its own.
      while (!page.text.empty() && page.text.back() == ' ') page.text.pop_back();
      const bool alone = page.text.empty() || page.text.back() == '\n';
      if (alone && at < text.size() && text[at] == '\n') ++at;
    } else {
      const std::size_t colon = first.find(':');
      const std::string spec = colon == std::string::npos ? ".3g" : first.substr(colon + 1);
      const std::string wanted = first.substr(0, colon);
      const auto found = operand(findings, wanted);
      page.text += found ? number(*found, spec) : missing("number", wanted);
    }
  }
  page.text += text.substr(at);
  return page;
}

}  // namespace shapeid::experiments
