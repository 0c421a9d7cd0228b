#include "shapeid/app/vector_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

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

void compare_numbers(const std::string& name, const json& expected, const json& within,
                     const json& output, Sentences& found) {
  const auto observed = number_list(output.contains(name) ? output[name] : json());
  if (!observed || observed->size() != expected.size()) {
    found.push_back(fmt::format("{} is not a list of {} finite numbers", name, expected.size()));
    return;
  }
  for (std::size_t i = 0; i < observed->size(); ++i) {
    const double wanted = expected[i].get<double>(),
                 allowed = (within.is_array() ? within[i] : within).get<double>();
    if (std::abs((*observed)[i] - wanted) <= allowed) continue;
    found.push_back(fmt::format("{}[{}]: observed {:.17g}, expected {:.17g} within {:.1e}", name, i,
                                (*observed)[i], wanted, allowed));
  }
}

/// Masses are judged by what can be proved of them, not by other masses.
void judge_masses(const json& vector, const json& output, Sentences& found) {
  const StatedProblem problem = stated_problem_from_json(vector["input"].dump(), "input");
  const auto masses = number_list(output.contains("masses") ? output["masses"] : json());
  if (!masses || static_cast<Eigen::Index>(masses->size()) != problem.masses.shapes()) {
    found.push_back(
        fmt::format("masses are not a list of {} finite numbers", problem.masses.shapes()));
    return;
  }
  const Eigen::VectorXd m =
      Eigen::Map<const Eigen::VectorXd>(masses->data(), problem.masses.shapes());
  const Answer answer{problem_digest(problem), m, problem.masses.U * m,
                      objective(problem.masses, m).total()};
  certificate::Tolerance tolerance;
  tolerance.gap = vector["expected"]["certified_gap"].get<double>();
  for (const std::string& reason : certify(problem, answer, tolerance).reasons) {
    found.push_back(reason);
  }
}

}  // namespace

Vectors read_vectors(const std::string& folder) {
  const JsonSource source{folder + "/index.json", manual};
  const json index = parse_document(read_small_file(source.name, largest_file), source, format,
                                    {"made_by", "flags", "files"});
  Vectors vectors{member(index, "flags", source), {}};
  for (const auto& [kind, recorded] : member(index, "files", source).items()) {
    const JsonSource file{fmt::format("{}/{}.json", folder, kind), manual};
    const std::string text = read_small_file(file.name, largest_file);
    if (digest(text) != recorded) {
      throw InputError({file.name}, "is not what the tool wrote: its digest differs",
                       "an unchanged file");
    }
    const json document = parse_document(text, file, format, {"kind", "seed", "cases"});
    vectors.files.push_back({kind, member(document, "cases", file)});
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
