// How much longer contacts must count as touching than they are declared, where torque is delayed.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

/// s: a contact counts as touching for so long before and after it is declared to. That costs rows,
/// and is never wrong; of errors with and without a delay the same rows count then.
struct ContactReach {
  double before = 0.0, after = 0.0;

  [[nodiscard]] bool covers(const ContactReach& other) const {
    return before >= other.before && after >= other.after;
  }
};

/// What the delays of torque among these ask for, and `present`, in whole samples of `rate` (Hz).
[[nodiscard]] ContactReach contact_reach(const std::vector<Found>& found, double rate,
                                         const ContactReach& present);

struct LoopInReach {
  LoopResult loop;
  ContactReach reach;
};
/// close_loop(); again where it finds a delay of the torque beyond the present reach, be it among
/// the causes of its first search, with contacts that count as touching for longer in `log`,
/// `reference` (may be null) and the logs `along` (null ones are passed over); what
/// `settings.rough` and `settings.rough_reference` point to belongs among these. Three times at
/// most. Throws as close_loop() does.
[[nodiscard]] LoopInReach close_loop_in_reach(const Robot& robot, Recording& log,
                                              Recording* reference,
                                              const std::vector<Recording*>& along,
                                              const LoopSettings& settings);

}  // namespace shapeid::diagnosis
