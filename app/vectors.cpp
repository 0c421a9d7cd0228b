// shapeid vectors: another implementation, asked all vectors by pipe.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "shapeid/app/foreign_program.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/vector_cases.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

struct VectorsArguments {
  std::string program, folder, kind;
  std::size_t shown = 3;
  bool json_wanted = false;
};

struct Tally {
  std::size_t cases = 0, failed = 0;
};

/// Input, observed, expected, and what the flags say of it.
std::string failure_text(const json& vector, const std::vector<std::string>& found,
                         const json& flags) {
  std::string text = fmt::format("{}\n", vector["id"].get<std::string>());
  std::string input = vector["input"].dump();
  constexpr std::size_t most = 300;
  if (input.size() > most) input = input.substr(0, most) + " ...";
  text += fmt::format("  input: {}\n", input);
  for (std::size_t i = 0; i < found.size() && i < 3; ++i) text += "  " + found[i] + "\n";
  if (found.size() > 3) text += fmt::format("  and {} more\n", found.size() - 3);
  for (const json& flag : vector["flags"]) {
    const auto name = flag.get<std::string>();
    text += fmt::format("  {}: {}\n", name, flags.value(name, std::string()));
  }
  return text;
}

/// A line that a program printed besides its answers is known by its beginning.
std::string no_object(const std::string& line) {
  constexpr std::size_t shown = 60;
  return "the answer is not a JSON object: " + one_line(line, shown);
}

void check_kind(const Vectors& all, const std::string& kind) {
  std::vector<std::string> kinds;
  for (const VectorFile& file : all.files) kinds.push_back(file.kind);
  if (kind.empty() || std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) return;
  throw InputError("--kind: no vectors of kind " + kind, fmt::format("{}", fmt::join(kinds, ", ")));
}

void vectors(const VectorsArguments& options) {
  const Vectors all = read_vectors(options.folder);
  check_kind(all, options.kind);
  ForeignProgram program(options.program);
  std::map<std::string, Tally> tallies;
  json failures = json::array();
  std::size_t failed = 0;
  for (const VectorFile& file : all.files) {
    if (!options.kind.empty() && options.kind != file.kind) continue;
    Tally& tally = tallies[file.kind];
    for (const json& vector : file.cases) {
      const json question = {{"id", vector["id"]}, {"kind", file.kind}, {"input", vector["input"]}};
      const std::string line = program.ask(question.dump());
      const json answer = parsed_answer(line);
      const auto found =
          answer.is_object() ? differences(vector, answer) : std::vector{no_object(line)};
      ++tally.cases;
      if (found.empty()) continue;
      ++failed;
      if (++tally.failed <= options.shown && !options.json_wanted) {
        fmt::print("{}", failure_text(vector, found, all.flags));
      }
      failures.push_back({{"id", vector["id"]}, {"found", found}});
    }
  }
  json summary;
  for (const auto& [kind, tally] : tallies) {
    summary[kind] = {{"cases", tally.cases}, {"failed", tally.failed}};
    if (!options.json_wanted) {
      fmt::print("{:<12}{:>5} cases{:>5} failed\n", kind, tally.cases, tally.failed);
    }
  }
  if (options.json_wanted) {
    fmt::print("{}\n", json_text({{"kinds", summary}, {"failures", failures}}, 2));
  }
  if (failed > 0) throw Refusal("vectors-failed", fmt::format("{} vectors failed", failed));
}

}  // namespace

void add_vectors(CLI::App& app) {
  const auto options = std::make_shared<VectorsArguments>();
  options->folder = SHAPEID_SOURCE_DIR "/tests/vectors";
  CLI::App* verb =
      app.add_subcommand("vectors", "run another implementation over the test vectors, by pipe");
  verb->add_option("--check", options->program,
                   "command that answers each line of JSON with one (docs/formats/vectors.md)")
      ->required();
  verb->add_option("--kind", options->kind, "only vectors of this kind");
  verb->add_option("--vectors", options->folder, "folder with index.json")->capture_default_str();
  verb->add_option("--shown", options->shown, "failures of a kind that are shown")
      ->check(count_from(0))
      ->capture_default_str();
  verb->add_flag("--json", options->json_wanted, "print the report as JSON");
  verb->callback([options] { vectors(*options); });
}

}  // namespace shapeid::app
