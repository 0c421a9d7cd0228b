#include "shapeid/app/vector_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>

#include "shapeid/models/error.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/strict_json.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/proofs/certificate/certify.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;
using Sentences = std::vector<std::string>;

constexpr const char* format = "shapeid-vectors-1";
constexpr const char* manual = "docs/formats/vectors.md";
constexpr std::size_t largest_file = std::size_t{1} << 26U;

/// A list of finite numbers, or nothing.
std::optional<std::vector<double>> number_list(const json& value) {
  if (!value.is_array()) return std::nullopt;
  std::vector<double> list;
  for (const json& entry : value) {
    if (!entry.is_number() || !std::isfinite(entry.get<double>())) return std::nullopt;
    list.push_back(entry.get<double>());
  }
  return list;
}

/// Why the member is no list of as many finite numbers, if it is none.
std::optional<std::string> why_no_list(const json& output, const std::string& name,
                                       Eigen::Index size) {
  if (!output.contains(name)) {
    return fmt::format("{} is missing: a list of {} finite numbers", name, size);
  }
  const auto list = number_list(output[name]);
  if (!list) return fmt::format("{} is not a list of {} finite numbers", name, size);
  if (std::cmp_equal(list->size(), size)) return std::nullopt;
  return fmt::format("{} is a list of {} numbers, expected {}", name, list->size(), size);
}

void compare_numbers(const std::string& name, const json& expected, const json& within,
                     const json& output, Sentences& found) {
  const JsonSource source{"vector", manual};
  const Eigen::VectorXd wanted = numbers(expected, name, source);
  const Eigen::VectorXd bounds =
      within.is_array() ? numbers(within, name, source)
                        : Eigen::VectorXd::Constant(wanted.size(), number(within, name, source));
  if (auto why = why_no_list(output, name, wanted.size())) {
    found.push_back(std::move(*why));
    return;
  }
  const Eigen::VectorXd observed = numbers(output[name], name, source);
  for (Eigen::Index i = 0; i < wanted.size(); ++i) {
    const double here = observed[i];
    if (std::abs(here - wanted[i]) <= bounds[i]) continue;
    found.push_back(fmt::format("{}[{}]: observed {:.17g}, expected {:.17g} within {:.1e}", name, i,
                                here, wanted[i], bounds[i]));
  }
}

/// Masses are judged by what can be proved of them, not by other masses.
void judge_masses(const json& vector, const json& output, Sentences& found) {
  const StatedProblem problem = stated_problem_from_json(vector["input"].dump(), "input");
  if (auto why = why_no_list(output, "masses", problem.masses.shapes())) {
    found.push_back(std::move(*why));
    return;
  }
  const Eigen::VectorXd m = numbers(output["masses"], "masses", {"answer", manual});
  const Answer answer{problem_digest(problem), m, problem.masses.U * m,
                      objective(problem.masses, m).total()};
  if (const Violation unfit = certificate::why_unfit(problem, answer)) {
    found.push_back(*unfit);
    return;
  }
  certificate::Tolerance tolerance;
  tolerance.gap = number(vector["expected"]["certified_gap"], "certified_gap", {"vector", manual});
  for (const std::string& reason : certify(problem, answer, tolerance).reasons) {
    found.push_back(reason);
  }
}

/// Throws InputError unless there is a bound, or one each, for a list of numbers.
void check_expectation(const std::string& name, const json& expected, const json& within,
                       const JsonSource& source) {
  const Eigen::VectorXd wanted = numbers(expected, name, source);
  if (!within.is_object())
    throw InputError(place_of_key(source, "within"), "not an object", "bounds");
  const json& bound = member(within, name, source);
  if (!bound.is_array()) {
    static_cast<void>(number(bound, name, source));
  } else if (numbers(bound, name, source).size() != wanted.size()) {
    throw InputError(place_of_key(source, name), "has as many bounds as numbers",
                     "one, or one each");
  }
}

void check_case(const json& vector, const std::string& kind, const JsonSource& source) {
  check_keys(vector, kind, source, {"id", "flags", "input", "expected", "within"});
  static_cast<void>(text(member(vector, "id", source), "id", source));
  const json& flags = member(vector, "flags", source);
  if (!flags.is_array() && !flags.is_null()) {
    throw InputError(place_of_key(source, "flags"), "not a list", "names, or null");
  }
  for (const json& flag : flags) static_cast<void>(text(flag, "flags", source));
  const json& input = member(vector, "input", source);
  const json& expected = member(vector, "expected", source);
  if (!expected.is_object())
    throw InputError(place_of_key(source, "expected"), "not an object", "one");
  for (const auto& [name, value] : expected.items()) {
    if (name == "certified_gap") {
      static_cast<void>(number(value, name, source));
      static_cast<void>(stated_problem_from_json(input.dump(), source.name));
    } else if (!value.is_boolean()) {
      check_expectation(name, value, member(vector, "within", source), source);
    }
  }
}

}  // namespace

VectorFile vector_file_from_json(const std::string& text, const std::string& name) {
  const JsonSource source{name, manual};
  const json document = parse_document(text, source, format, {"kind", "seed", "cases"});
  VectorFile file{shapeid::text(member(document, "kind", source), "kind", source),
                  member(document, "cases", source)};
  if (!file.cases.is_array())
    throw InputError(place_of_key(source, "cases"), "not a list", "of cases");
  for (const json& vector : file.cases) check_case(vector, file.kind, source);
  return file;
}

json parsed_answer(const std::string& line) {
  try {
    return parse_json(line, {"answer", manual});
  } catch (const InputError&) {
    return nullptr;
  }
}

Vectors read_vectors(const std::string& folder) {
  const JsonSource source{folder + "/index.json", manual};
  const json index = parse_document(read_small_file(source.name, largest_file), source, format,
                                    {"made_by", "flags", "files"});
  Vectors vectors{member(index, "flags", source), {}};
  if (!vectors.flags.is_object())
    throw InputError(place_of_key(source, "flags"), "not an object", "one");
  for (const auto& [flag, meaning] : vectors.flags.items()) {
    static_cast<void>(text(meaning, flag, source));
  }
  for (const auto& [kind, recorded] : member(index, "files", source).items()) {
    if (kind.find('/') != std::string::npos) {
      throw InputError(place_of_key(source, kind), "leads out of the folder",
                       "a name without slashes");
    }
    const std::string name = fmt::format("{}/{}.json", folder, kind);
    const std::string text = read_small_file(name, largest_file);
    if (digest(text) != recorded) {
      throw InputError({name}, "is not what the tool wrote: its digest differs",
                       "an unchanged file");
    }
    vectors.files.push_back(vector_file_from_json(text, name));
  }
  return vectors;
}

Sentences differences(const json& vector, const json& output) {
  Sentences found;
  if (!output.is_object()) return {"the answer is not a JSON object"};
  for (const auto& [name, expected] : vector["expected"].items()) {
    if (name == "certified_gap") {
      judge_masses(vector, output, found);
    } else if (expected.is_boolean()) {
      const json observed = output.contains(name) ? output[name] : json();
      if (observed != expected) {
        found.push_back(
            fmt::format("{}: observed {}, expected {}", name, observed.dump(), expected.dump()));
      }
    } else {
      compare_numbers(name, expected, vector["within"][name], output, found);
    }
  }
  return found;
}

}  // namespace shapeid::app
