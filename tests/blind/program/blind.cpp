// blind generate FOLDER, blind score FOLDER...: the two ends of ./run blind. Between them the
// diagnosis sees what is in FOLDER/trial*/ but sealed.json.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "shapeid/tests/blind/parts/plan.hpp"
#include "shapeid/tests/blind/parts/score.hpp"
#include "shapeid/tests/blind/parts/yardstick.hpp"

namespace {

namespace fs = std::filesystem;
using namespace shapeid::blind;

nlohmann::json read_json(const fs::path& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

std::string items_text(const Trial& trial) {
  const Machine m = machine(trial.machine);
  std::string text;
  for (const Item& item : trial.items) {
    text += fmt::format("{}{}@{} {:.3g} ({:g}x)", text.empty() ? "" : ", ", item.kind,
                        place_name(m, kind(item.kind).place, item.amount.site), item.amount.size,
                        item.ratio);
  }
  return text.empty() ? "clean" : text;
}

Scored score_trial(const fs::path& folder) {
  Scored s;
  s.trial = trial_from_json(read_json(folder / "sealed.json"));
  const fs::path said = folder / "result.json";
  const bool answered = fs::exists(said) && fs::file_size(said) > 0;
  const nlohmann::json result = answered ? read_json(said) : nlohmann::json();
  s.judgement = judge(s.trial, result);
  const bool has_numbers =
      std::all_of(s.trial.items.begin(), s.trial.items.end(),
                  [](const Item& item) { return kind(item.kind).values != nullptr; });
  if (answered && has_numbers) {
    const Machine m = machine(s.trial.machine);
    double sum = 0.0;
    for (const double rms : result.at("heldout_rms_after")) sum += rms * rms;
    s.judgement.error_ratio =
        std::sqrt(sum) / told_truth_error(m, s.trial, read_log(m, folder / "log.csv"),
                                          read_log(m, folder / "test.csv"));
  }
  return s;
}

void score(const std::vector<std::string>& folders) {
  std::vector<fs::path> trials;
  for (const std::string& folder : folders) {
    const auto before = std::ssize(trials);
    for (const auto& entry : fs::directory_iterator(folder)) {
      // Made, but not diagnosed yet: a run that was stopped is scored as far as it came.
      const bool complete =
          fs::exists(entry.path() / "sealed.json") && fs::exists(entry.path() / "result.json");
      if (complete) trials.push_back(entry.path());
    }
    std::sort(trials.begin() + before, trials.end());
  }
  std::vector<Scored> all;
  std::string lines;
  for (const fs::path& trial : trials) {
    const Scored s = score_trial(trial);
    if (!s.trial.error.empty()) {
      fmt::print(stderr, "{}: {}\n", trial.filename().string(), s.trial.error);
      continue;
    }
    const double ratio = s.judgement.error_ratio;
    lines += fmt::format("| {} | {} | {} | {}{} | {} |\n", s.trial.machine, items_text(s.trial),
                         s.judgement.said, name_of(s.judgement.outcome),
                         s.judgement.beside ? " beside" : "",
                         ratio > 0.0 ? fmt::format("{:.3f}", ratio) : "-");
    all.push_back(s);
  }
  fmt::print(
      "{}Every trial:\n\n| robot | truth | said | outcome | error over told |\n"
      "|---|---|---|---|---|\n{}",
      tables(all), lines);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("generates and scores blind trials of the diagnosis");
  app.require_subcommand(1);
  std::string folder;
  PlanOptions options;
  CLI::App* generating = app.add_subcommand("generate", "writes logs and sealed truths");
  generating->add_option("folder", folder)->required();
  generating->add_option("--trials", options.trials)->capture_default_str();
  generating->add_option("--seed", options.seed)->capture_default_str();
  generating->add_option("--quadruped-every", options.quadruped_every)->capture_default_str();
  generating->add_option("--ratio", options.ratio, "times the detectable size (default: drawn)");
  generating->add_option("--only", options.only, "this kind alone, or clean");
  CLI::App* scoring = app.add_subcommand("score", "opens the seals and prints the tables");
  std::vector<std::string> folders;
  scoring->add_option("folders", folders, "all in one table")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (generating->parsed()) {
      generate(options, folder, [](int number, const Trial& trial) {
        fmt::print(stderr, "\rgenerated {} ({})   ", number + 1, trial.machine);
      });
      fmt::print(stderr, "\n");
    } else {
      score(folders);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "blind: {}\n", e.what());
    return 1;
  }
  return 0;
}
