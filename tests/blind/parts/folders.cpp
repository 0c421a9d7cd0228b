#include "shapeid/tests/blind/parts/folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "shapeid/tests/blind/parts/yardstick.hpp"

namespace shapeid::blind {
namespace {

namespace fs = std::filesystem;

nlohmann::json read_document(const fs::path& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

}  // namespace

TrialFolders find_trials(const std::vector<std::string>& folders) {
  TrialFolders found;
  for (const std::string& folder : folders) {
    const auto before = std::ssize(found.ended);
    for (const auto& entry : fs::directory_iterator(folder)) {
      const fs::path& trial = entry.path();
      if (!fs::exists(trial / "sealed.json")) continue;
      if (!fs::exists(trial / "log.csv")) {
        ++found.fallen;
        continue;
      }
      ++found.made;
      const bool answered = fs::exists(trial / "result.json");
      const bool crashed = !answered && fs::exists(trial / "crashed");
      if (crashed) ++found.crashed;
      if (answered || crashed) found.ended.push_back(trial);
    }
    std::sort(found.ended.begin() + before, found.ended.end());
  }
  return found;
}

std::string how_many(const TrialFolders& found) {
  const auto answered = static_cast<int>(found.ended.size()) - found.crashed;
  std::string text = fmt::format("{} of {} trials diagnosed", answered, found.made);
  if (found.crashed > 0) text += fmt::format(", {} more crashed", found.crashed);
  if (found.fallen > 0) text += fmt::format("; of {} others the robot fell", found.fallen);
  return text + ".";
}

Scored score_trial(const fs::path& folder) {
  Scored s;
  s.trial = trial_from_json(read_document(folder / "sealed.json"));
  const fs::path said = folder / "result.json";
  if (!fs::exists(said)) {
    s.judgement.outcome = Outcome::crashed;
    return s;
  }
  const bool answered = fs::file_size(said) > 0;
  const nlohmann::json result = answered ? read_document(said) : nlohmann::json();
  s.judgement = judge(s.trial, result);
  const bool has_numbers =
      std::all_of(s.trial.items.begin(), s.trial.items.end(),
                  [](const Item& item) { return kind(item.kind).values != nullptr; });
  if (answered && has_numbers) {
    const Machine m = machine(s.trial.machine);
    double sum = 0.0;
    for (const double rms : result.at("heldout_rms_after")) sum += rms * rms;
    const ToldTruth told =
        told_truth(m, s.trial, read_log(m, folder / "log.csv"), read_log(m, folder / "test.csv"));
    s.judgement.error_ratio = std::sqrt(sum) / told.error;
    s.judgement.told = distance_from_truth(m, told.inertias);
  }
  return s;
}

}  // namespace shapeid::blind
