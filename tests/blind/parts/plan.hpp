// Which trials there are: drawn from a seed, so that two people see the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/blind/parts/trial.hpp"

namespace shapeid::blind {

struct PlanOptions {
  std::uint64_t seed = 1;
  int first = 0;  ///< the number of the first trial: what is in one does not depend on others
  int trials = 20;
  int quadruped_every = 4;  ///< every how many trials; 0: arms alone
  bool drawn_arms = false;  ///< each arm is another one (drawn.hpp); phases are of five motions
  bool drawn_quadrupeds = false;  ///< likewise (drawn_quadruped.hpp)
  double ratio = 0.0;             ///< times the detectable size, of every effect; 0: drawn
  /// Trials of this kind alone, of none ("clean") or of each that is not in the catalogue
  /// ("foreign"); empty: all kinds.
  std::string only;
  /// Every trial has a reference log, and what of the catalogue is in it came since then or went:
  /// each of both in half of them. What robots are built of does neither.
  bool changes = false;
};

/// Whether a trial with this noise has a reference log that it does not need: a third do, whatever
/// is in them.
[[nodiscard]] bool has_spare_reference(std::uint64_t noise_seed);

/// Of ten trials two are clean, five hold one effect, one holds two, and two hold something that
/// is not in the catalogue. Sizes are 0.5, 1, 2, 4 or 8 times the detectable size.
/// With a trial that needs no reference log one comes nevertheless in a third of all, so that its
/// presence tells nothing.
/// Writes one folder a trial into `folder`: what the diagnosis may see (write_logs()), and
/// sealed.json for the scorer alone. `on_trial` hears of each.
void generate(const PlanOptions& options, const std::string& folder,
              const std::function<void(int, const Trial&)>& on_trial = {});

}  // namespace shapeid::blind
