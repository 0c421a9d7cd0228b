// One blind trial: what is in it, as the sealed file says, and the logs that show it.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include "shapeid/tests/blind/parts/ingredients.hpp"

namespace shapeid::blind {

/// Something that is in a trial.
struct Item {
  std::string kind;
  Amount amount;
  double ratio = 0.0;  ///< size over the detectable one; 0 if no size can be detected
};

/// Which logs the items of a trial are in.
enum class Acts {
  as_usual,     ///< loads in the log, all else in the reference log, too
  in_log,       ///< they came since the reference log
  in_reference  ///< they went since then
};

struct Trial {
  std::string machine;
  std::uint64_t motion_seed = 1, noise_seed = 1, inertia_seed = 1;
  std::vector<Item> items;
  bool reference = false;  ///< a log without the loads comes with it
  Acts acts = Acts::as_usual;
  std::string error;  ///< why there is no log (the robot fell); else empty
};

/// Whether something in it is told from its link only by a log without it: a load that was never
/// absent.
[[nodiscard]] bool needs_reference(const Trial& trial);
/// Those of the items that act as usual in a reference log: all but loads, which were put on since.
[[nodiscard]] std::vector<Item> without_loads(std::vector<Item> items);
[[nodiscard]] std::vector<Item> items_in_log(const Trial& trial);
[[nodiscard]] std::vector<Item> items_in_reference(const Trial& trial);

[[nodiscard]] nlohmann::json to_json(const Trial& trial);
/// Of seals that say nothing of a reference: there was one where it was needed.
[[nodiscard]] Trial trial_from_json(const nlohmann::json& document);

/// Seconds for the diagnosis to fit, and after them to test on.
inline constexpr double fitted_seconds = 12.0, tested_seconds = 4.0;

/// The simulated truth of a trial, before any noise. Empty if the robot falls.
[[nodiscard]] Readings simulate_trial(const Machine& machine, const Trial& trial);
/// The motion of the trial's seed with nothing in it.
[[nodiscard]] Readings simulate_clean(const Machine& machine, std::uint64_t motion_seed);

/// What the items that act on signals alone make of clean readings.
void change_signals(const Machine& machine, const std::vector<Item>& items, Readings& readings);
/// Whether anything in the trial must be simulated.
[[nodiscard]] bool is_dynamic(const Trial& trial);

/// Writes log.csv and test.csv (with noise), given.urdf, given.robot.yaml and cutoff, the filter's
/// in Hz, into the folder, which exists.
void write_logs(const Machine& machine, const Trial& trial, const Readings& readings,
                const std::string& folder);

}  // namespace shapeid::blind
