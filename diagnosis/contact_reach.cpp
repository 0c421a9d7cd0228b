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
  constexpr int most = 2;
  std::vector<Recording*> all = along;
  all.insert(all.end(), {&log, reference});
  LoopInReach result;
  for (int extended = 0;; ++extended) {
    const bool may_extend = extended < most && has_contact_flags(log, settings);
    ContactReach needed;
    const auto beyond = [&](const std::vector<Found>& found) {
      needed = contact_reach(found, log.rate(), result.reach);
      return may_extend && !result.reach.covers(needed);
    };
    const double screening = result.loop.screening_seconds, refits = result.loop.refit_seconds;
    LoopOrCauses closed = close_loop_unless(beyond, robot, log, reference, settings);
    result.loop = std::move(closed.result);
    result.loop.screening_seconds += screening;
    result.loop.refit_seconds += refits;
    if (closed.is_closed && !beyond(result.loop.found)) return result;
    result.reach = needed;
    for (Recording* of : all) {
      if (of != nullptr) of->extend_contacts(needed.before, needed.after);
    }
  }
}

}  // namespace shapeid::diagnosis
