// What a folder of blind trials holds: made, diagnosed, crashed, or waiting still.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shapeid/tests/blind/parts/score.hpp"

namespace shapeid::blind {

struct TrialFolders {
  std::vector<std::filesystem::path> ended;  ///< with an answer or a crash, sorted in each folder
  int made = 0;                              ///< with a seal and a log
  int crashed = 0;                           ///< of the ended
  int fallen = 0;                            ///< sealed, but the robot fell: no log
};

/// Trials of all these folders. One without a result is counted too: a table that lacks what the
/// diagnosis could not answer would be of the easier ones.
[[nodiscard]] TrialFolders find_trials(const std::vector<std::string>& folders);

/// "98 of 100 trials diagnosed, 1 more crashed."
[[nodiscard]] std::string how_many(const TrialFolders& found);

/// Opens the seal of one that ended.
[[nodiscard]] Scored score_trial(const std::filesystem::path& folder);

}  // namespace shapeid::blind
