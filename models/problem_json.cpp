#include "shapeid/models/problem_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/models/shape_json.hpp"
#include "shapeid/models/strict_json.hpp"

namespace shapeid {
namespace {

using nlohmann::json;

constexpr const char* problem_format = "shapeid-problem-1";
constexpr const char* answer_format = "shapeid-answer-1";
constexpr const char* manual = "docs/formats/problem.md";

/// No robot has more; a count beyond it is a slip.
constexpr Eigen::Index most_links = 10000;

json bounds_json(const Eigen::VectorXd& bounds) {
  json list = json::array();
  for (const double b : bounds) list.push_back(std::isfinite(b) ? json(b) : json());
  return list;
}

Eigen::VectorXd bounds_from(const json& value, double none, const std::string& key,
                            const JsonSource& source) {
  if (!value.is_array()) {
    throw InputError(place_of_key(source, key), "not a list",
                     "numbers, null where there is no bound");
  }
  Eigen::VectorXd bounds(static_cast<Eigen::Index>(value.size()));
  for (Eigen::Index k = 0; k < bounds.size(); ++k) {
    const json& b = value[static_cast<std::size_t>(k)];
    bounds[k] = b.is_null() ? none : number(b, key, source);
  }
  return bounds;
}

OtherColumns others_from(const json& object, const JsonSource& source) {
  check_keys(object, "columns", source, {"values", "lower", "upper"});
  OtherColumns C;
  C.lower = bounds_from(member(object, "lower", source), -HUGE_VAL, "lower", source);
  C.upper = bounds_from(member(object, "upper", source), HUGE_VAL, "upper", source);
  C.values = matrix(member(object, "values", source), C.lower.size(), "values", source);
  return C;
}

json regions_json(const std::vector<Region>& regions) {
  json list = json::array();
  for (const Region& region : regions) {
    list.push_back(shape_json(region.shape));
    list.back()["link"] = region.link;
  }
  return list;
}

std::vector<Region> regions_from(const json& list, const std::string& key,
                                 const JsonSource& source) {
  if (!list.is_array()) throw InputError(place_of_key(source, key), "not a list", "of shapes");
  std::vector<Region> regions;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonSource place{fmt::format("{}, {}[{}]", source.name, key, i), source.manual};
    Shape shape = shape_from_json(list[i], "", place);
    regions.push_back(
        {count(member(list[i], "link", place), most_links, "link", place), std::move(shape)});
  }
  return regions;
}

}  // namespace

std::string problem_to_json(const StatedProblem& stated) {
  const MassProblem& p = stated.masses;
  json document = {{"format", problem_format},  {"free_links", p.U.rows() / 10},
                   {"Y", matrix_json(p.Y)},     {"F", vector_json(p.F)},
                   {"W", vector_json(p.W)},     {"U", matrix_json(p.U)},
                   {"V", vector_json(p.V)},     {"lambda", p.lambda},
                   {"mass_bound", p.mass_bound}};
  if (stated.others.values.cols() > 0) {
    document["columns"] = {{"values", matrix_json(stated.others.values)},
                           {"lower", bounds_json(stated.others.lower)},
                           {"upper", bounds_json(stated.others.upper)}};
  }
  if (!stated.regions.empty()) document["regions"] = regions_json(stated.regions);
  if (!stated.shapes.empty()) document["shapes"] = regions_json(stated.shapes);
  return document.dump() + "\n";
}

std::string problem_to_json(const MassProblem& problem) {
  return problem_to_json(StatedProblem{problem, {}, {}});
}

StatedProblem stated_problem_from_json(const std::string& text, const std::string& name) {
  const JsonSource source{name, manual};
  const json document = parse_document(text, source, problem_format,
                                       {"free_links", "Y", "F", "W", "U", "V", "lambda",
                                        "mass_bound", "columns", "regions", "shapes"});
  StatedProblem stated;
  MassProblem& p = stated.masses;
  p.F = numbers(member(document, "F", source), "F", source);
  p.W = numbers(member(document, "W", source), "W", source);
  p.V = numbers(member(document, "V", source), "V", source);
  const Eigen::Index links =
      count(member(document, "free_links", source), most_links, "free_links", source);
  p.Y = matrix(member(document, "Y", source), 10 * links, "Y", source);
  p.U = matrix(member(document, "U", source), p.V.size(), "U", source);
  p.lambda = number(member(document, "lambda", source), "lambda", source);
  p.mass_bound = number(member(document, "mass_bound", source), "mass_bound", source);
  if (document.contains("columns")) stated.others = others_from(document["columns"], source);
  for (const auto& [key, place] : {std::pair("regions", &StatedProblem::regions),
                                   std::pair("shapes", &StatedProblem::shapes)}) {
    if (document.contains(key)) stated.*place = regions_from(document[key], key, source);
  }
  if (const Violation why = why_malformed(stated)) {
    throw InputError({name}, *why, fmt::format("see {}", manual));
  }
  return stated;
}

MassProblem problem_from_json(const std::string& text, const std::string& name) {
  StatedProblem stated = stated_problem_from_json(text, name);
  if (stated.others.values.cols() > 0) {
    throw InputError(place_of_key({name, manual}, "columns"), "has columns besides masses",
                     "a problem of masses");
  }
  return std::move(stated.masses);
}

std::string answer_to_json(const Answer& answer) {
  json document = {{"format", answer_format},
                   {"problem_digest", answer.problem_digest},
                   {"parameters", vector_json(answer.parameters)},
                   {"objective", answer.objective}};
  if (answer.masses.size() > 0) document["masses"] = vector_json(answer.masses);
  if (answer.others.size() > 0) document["columns"] = vector_json(answer.others);
  return document.dump() + "\n";
}

Answer answer_from_json(const std::string& text, const std::string& name) {
  const JsonSource source{name, manual};
  const json document =
      parse_document(text, source, answer_format,
                     {"problem_digest", "masses", "parameters", "objective", "columns"});
  Answer answer;
  answer.problem_digest =
      shapeid::text(member(document, "problem_digest", source), "problem_digest", source);
  answer.parameters = numbers(member(document, "parameters", source), "parameters", source);
  answer.objective = number(member(document, "objective", source), "objective", source);
  if (document.contains("masses")) {
    answer.masses = numbers(document["masses"], "masses", source);
    if (answer.masses.size() == 0) {
      throw InputError(place_of_key(source, "masses"), "an empty list",
                       "leave the key out where parameters alone are claimed");
    }
  }
  if (document.contains("columns")) answer.others = numbers(document["columns"], "columns", source);
  return answer;
}

std::string problem_digest(const StatedProblem& problem) {
  return digest(problem_to_json(problem));
}

std::string problem_digest(const MassProblem& problem) { return digest(problem_to_json(problem)); }

}  // namespace shapeid
