// The loop with contacts that count as touching for longer than the log says: flags that come late
// or go early are sought before it, and asked again after it.
#pragma once

#include <vector>

#include "shapeid/diagnosis/contact_reach.hpp"
#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

struct LoopWithContacts {
  LoopResult loop;
  ContactReach reach;
  /// contact_late and contact_short, not among what the loop found; their gain is that of having
  /// one, all others and all that the loop found in.
  std::vector<Found> flags;
};

/// correct_contact_flags() and close_loop_in_reach(). A flag was found beside masses alone: if its
/// force explains no more than chance beside all that the loop found, the logs go back to what they
/// were before this flag was corrected, and the loop is closed again. The logs are left with the
/// contacts of the last loop. Arguments and errors as there.
[[nodiscard]] LoopWithContacts close_loop_with_contacts(const Robot& robot, Recording& log,
                                                        Recording* reference,
                                                        const std::vector<Recording*>& along,
                                                        const LoopSettings& settings);

}  // namespace shapeid::diagnosis
