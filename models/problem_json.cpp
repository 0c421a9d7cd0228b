#include "shapeid/models/problem_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

using nlohmann::json;

constexpr const char* problem_format = "shapeid-problem-1";
constexpr const char* answer_format = "shapeid-answer-1";

json vector_json(const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); }

/// Row by row, as a reader of the file would write the matrix down.
json matrix_json(const Eigen::MatrixXd& M) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < M.rows(); ++i) rows.push_back(vector_json(M.row(i).transpose()));
  return rows;
}

json parse(const std::string& text, const std::string& name, const char* format,
           const std::set<std::string>& keys) {
  json document;
  try {
    document = json::parse(text);
  } catch (const json::parse_error& e) {
    throw InputError({name}, fmt::format("is not JSON (at byte {})", e.byte),
                     "see docs/formats/problem.md");
  } catch (const json::out_of_range&) {
    throw InputError({name}, "a number is larger than any double", "write finite decimals");
  }
  if (!document.is_object() || !document.contains("format") || document["format"] != format) {
    throw InputError({name}, "has no or another format",
                     fmt::format("\"format\" must be \"{}\"", format));
  }
  for (const auto& item : document.items()) {
    if (item.key() != "format" && !keys.contains(item.key())) {
      throw InputError({name, 0, item.key()}, "unknown key", "see docs/formats/problem.md");
    }
  }
  return document;
}

const json& member(const json& document, const std::string& key, const std::string& name) {
  if (!document.contains(key)) throw InputError({name, 0, key}, "missing key", "it is required");
  return document[key];
}

double number(const json& value, const std::string& key, const std::string& name) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    throw InputError({name, 0, key}, "not a finite number", "write finite decimals");
  }
  return value.get<double>();
}

Eigen::VectorXd numbers(const json& value, const std::string& key, const std::string& name) {
  if (!value.is_array()) throw InputError({name, 0, key}, "not a list", "a list of numbers");
  Eigen::VectorXd v(static_cast<Eigen::Index>(value.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    v[i] = number(value[static_cast<std::size_t>(i)], key, name);
  }
  return v;
}

Eigen::MatrixXd matrix(const json& value, Eigen::Index columns, const std::string& key,
                       const std::string& name) {
  if (!value.is_array()) throw InputError({name, 0, key}, "not a list", "a list of rows");
  Eigen::MatrixXd M(static_cast<Eigen::Index>(value.size()), columns);
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    const Eigen::VectorXd row = numbers(value[static_cast<std::size_t>(i)], key, name);
    if (row.size() != columns) {
      throw InputError({name, 0, key}, fmt::format("row {} has {} numbers", i, row.size()),
                       fmt::format("every row has {}", columns));
    }
    M.row(i) = row.transpose();
  }
  return M;
}

}  // namespace

std::string problem_to_json(const MassProblem& p) {
  const json document = {{"format", problem_format},  {"free_links", p.U.rows() / 10},
                         {"Y", matrix_json(p.Y)},     {"F", vector_json(p.F)},
                         {"W", vector_json(p.W)},     {"U", matrix_json(p.U)},
                         {"V", vector_json(p.V)},     {"lambda", p.lambda},
                         {"mass_bound", p.mass_bound}};
  return document.dump() + "\n";
}

MassProblem problem_from_json(const std::string& text, const std::string& name) {
  const json document = parse(text, name, problem_format,
                              {"free_links", "Y", "F", "W", "U", "V", "lambda", "mass_bound"});
  MassProblem p;
  p.F = numbers(member(document, "F", name), "F", name);
  p.W = numbers(member(document, "W", name), "W", name);
  p.V = numbers(member(document, "V", name), "V", name);
  const double links = number(member(document, "free_links", name), "free_links", name);
  if (!(links >= 0.0 && links <= 1e4 && links == std::floor(links))) {
    throw InputError({name, 0, "free_links"}, "not a count of links", "0, 1, 2, ...");
  }
  const auto parameters = 10 * static_cast<Eigen::Index>(links);
  p.Y = matrix(member(document, "Y", name), parameters, "Y", name);
  p.U = matrix(member(document, "U", name), p.V.size(), "U", name);
  p.lambda = number(member(document, "lambda", name), "lambda", name);
  p.mass_bound = number(member(document, "mass_bound", name), "mass_bound", name);
  if (const Violation why = why_malformed(p)) {
    throw InputError({name}, *why, "see docs/formats/problem.md");
  }
  return p;
}

std::string answer_to_json(const Answer& answer) {
  json document = {{"format", answer_format},
                   {"problem_digest", answer.problem_digest},
                   {"parameters", vector_json(answer.parameters)},
                   {"objective", answer.objective}};
  if (answer.masses.size() > 0) document["masses"] = vector_json(answer.masses);
  return document.dump() + "\n";
}

Answer answer_from_json(const std::string& text, const std::string& name) {
  const json document =
      parse(text, name, answer_format, {"problem_digest", "masses", "parameters", "objective"});
  Answer answer;
  const json& digest = member(document, "problem_digest", name);
  if (!digest.is_string()) throw InputError({name, 0, "problem_digest"}, "not a text", "a text");
  answer.problem_digest = digest.get<std::string>();
  answer.parameters = numbers(member(document, "parameters", name), "parameters", name);
  answer.objective = number(member(document, "objective", name), "objective", name);
  if (document.contains("masses")) answer.masses = numbers(document["masses"], "masses", name);
  return answer;
}

std::string problem_digest(const MassProblem& problem) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : problem_to_json(problem)) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return fmt::format("{:016x}", hash);
}

}  // namespace shapeid
