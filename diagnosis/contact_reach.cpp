#include "shapeid/diagnosis/contact_reach.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/contact_flags.hpp"
#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {

ContactReach contact_reach(const std::vector<Found>& found, double rate,
                           const ContactReach& present) {
  ContactReach reach = present;
  for (const Found& f : found) {
    if (f.effect.effect != find_effect("torque_delay")) continue;
    const double delay = f.effect.value[0];
    if (std::abs(delay) * rate < 0.5) continue;  // the nearest sample is the same
    double& side = delay > 0.0 ? reach.after : reach.before;
    // Whose flags are taken is the nearest sample, at most so many away.
    side = std::max(side, std::ceil(std::abs(delay) * rate) / rate);
  }
  return reach;
}

LoopInReach close_loop_in_reach(const Robot& robot, Recording& log, Recording* reference,
                                const std::vector<Recording*>& along,
                                const LoopSettings& settings) {
  constexpr int most = 3;
  LoopInReach result{close_loop(robot, log, reference, settings), {}};
  for (int turn = 1; turn < most && has_contact_flags(log, settings); ++turn) {
    const ContactReach needed = contact_reach(result.loop.found, log.rate(), result.reach);
    if (result.reach.covers(needed)) break;
    result.reach = needed;
    std::vector<Recording*> all = along;
    all.insert(all.end(), {&log, reference});
    for (Recording* of : all) {
      if (of != nullptr) of->extend_contacts(needed.before, needed.after);
    }
    const double screening = result.loop.screening_seconds, refits = result.loop.refit_seconds;
    result.loop = close_loop(robot, log, reference, settings);
    result.loop.screening_seconds += screening;
    result.loop.refit_seconds += refits;
  }
  return result;
}

}  // namespace shapeid::diagnosis
