// blind generate FOLDER, blind score FOLDER...: the two ends of ./run blind. Between them the
// diagnosis sees what is in FOLDER/trial*/ but sealed.json.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>

#include "shapeid/tests/blind/parts/folders.hpp"
#include "shapeid/tests/blind/parts/plan.hpp"

namespace {

using namespace shapeid::blind;

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

const char* reference_text(const Trial& trial) {
  if (!trial.reference) return "";
  switch (trial.acts) {
    case Acts::in_log:
      return ", not in the reference";
    case Acts::in_reference:
      return ", in the reference alone";
    case Acts::as_usual:
      break;
  }
  return ", reference";
}

void score(const std::vector<std::string>& folders) {
  const TrialFolders found = find_trials(folders);
  std::vector<Scored> all;
  std::string lines;
  for (const std::filesystem::path& trial : found.ended) {
    const Scored s = score_trial(trial);
    const double ratio = s.judgement.error_ratio;
    lines += fmt::format("| {} | {}{} | {} | {}{} | {} |\n", s.trial.machine, items_text(s.trial),
                         reference_text(s.trial), s.judgement.said, name_of(s.judgement.outcome),
                         s.judgement.beside ? " beside" : "",
                         ratio > 0.0 ? fmt::format("{:.3f}", ratio) : "-");
    all.push_back(s);
  }
  fmt::print(
      "{}\n\n{}Every trial:\n\n| robot | truth | said | outcome | error over told |\n"
      "|---|---|---|---|---|\n{}",
      how_many(found), tables(all), lines);
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
  generating
      ->add_option("--first", options.first, "number of the first trial, those before left out")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  generating->add_option("--seed", options.seed)->capture_default_str();
  generating->add_option("--quadruped-every", options.quadruped_every)->capture_default_str();
  generating->add_flag("--drawn-arms", options.drawn_arms, "each arm is another one");
  generating->add_flag("--drawn-quadrupeds", options.drawn_quadrupeds,
                       "each quadruped is another one");
  generating->add_option("--ratio", options.ratio, "times the detectable size (default: drawn)");
  generating->add_option("--only", options.only,
                         "this kind alone, clean, or foreign: any that is not in the catalogue");
  generating->add_flag("--changes", options.changes,
                       "each with a reference log, since which its effects came or went");
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
