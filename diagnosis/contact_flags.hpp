// Contacts that begin before they are declared or last longer, sought before all else: an
// undeclared contact's force is larger than what any joint's law explains, and its course is no
// column's.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

/// Whether the log says what touches, and the loop uses it.
[[nodiscard]] bool has_contact_flags(const Recording& log, const LoopSettings& settings);

/// contact_late and contact_short where they are among the strongest of all hypotheses beside
/// masses, one after the other, each once. What is found is corrected in `log`, `reference` (may be
/// null) and the logs `along` (null ones are passed over), so that the contact's force is projected
/// away there; what `settings.rough` and `settings.rough_reference` point to belongs among these.
/// Throws as close_loop() does.
[[nodiscard]] std::vector<Found> correct_contact_flags(const Robot& robot, Recording& log,
                                                       Recording* reference,
                                                       const std::vector<Recording*>& along,
                                                       const LoopSettings& settings);

/// What the force of a flag that was found, beside masses alone, explains beside all that `loop`
/// found later; none if that is no more than chance. `log`, `reference` (may be null) and what
/// `settings` point to: as the loop saw them, but for this flag, which is as it was.
[[nodiscard]] std::optional<Gain> gain_beside(const Robot& robot, const Recording& log,
                                              const Recording* reference,
                                              const LoopSettings& settings, const LoopResult& loop,
                                              const Found& flag);

/// Whether a force at a foot (base axes) is one that the ground can have: on the log's mean it does
/// not pull.
[[nodiscard]] bool pushes(const Recording& log, const Eigen::Vector3d& force);

/// Whether a foot is about as fast, against those that stand, while the flag (contact_late or
/// contact_short, as found) would have it touch, as feet are in the air: one that touches stands.
[[nodiscard]] bool swings(const Robot& robot, const Recording& log, const AppliedEffect& flag);

/// The same correction of another log.
void correct_contact_flags(Recording& log, const std::vector<Found>& found);

}  // namespace shapeid::diagnosis
