// What a round of the loop looks at: hypotheses with their start, and as terms of a fit.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "shapeid/diagnosis/selection.hpp"
#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

/// All hypotheses; those of the model with their numbers, others once more with what numbers of
/// their shape the model has found at their place, ripple where the rest of the log has most of it
/// (what went, where that of the reference log has, if there is one), payloads only if the model
/// has them.
[[nodiscard]] std::vector<AppliedEffect> screened_hypotheses(const Robot& robot,
                                                             const RichModel& model,
                                                             const Rest& of_log,
                                                             const std::optional<Rest>& earlier);

/// Ten columns for each of these links.
[[nodiscard]] Term term_of_masses(const std::vector<int>& links);
/// The columns of one of the tally's hypotheses.
[[nodiscard]] Term term_of(const Robot& robot, const Tally& tally, std::size_t hypothesis);

[[nodiscard]] bool is_ripple(const AppliedEffect& effect);
/// How many periods of a ripple at its joint the log tells apart; 1 for what is no ripple.
[[nodiscard]] double periods_told_apart(const Recording& log, const AppliedEffect& effect);
/// Whether it is a ripple of which the joint goes through hardly a tenth of a period, as noise of
/// an encoder does where nothing moves: there it is what that noise makes of gravity.
[[nodiscard]] bool is_ripple_at_rest(const Recording& log, const AppliedEffect& effect);
/// Whether it is a ripple of which the joint goes through less than two periods.
[[nodiscard]] bool is_long_ripple(const Recording& log, const AppliedEffect& effect);
/// Whether it is a ripple that is faster than `frequency` (Hz) at more than half of the samples.
[[nodiscard]] bool is_fast_ripple(const Recording& log, const AppliedEffect& effect,
                                  double frequency);

struct CandidateRule {
  std::vector<int> free_links;  ///< a load that is always there cannot be told from these
  /// What came since the reference log is a hypothesis of its own, and what went.
  bool has_reference = false;
  bool transformations = false;  ///< whether effects that are no columns are tried
  /// Whether what is there with several shapes is sought with each, not with the first alone.
  bool several_shapes = false;
  std::function<bool(const AppliedEffect&)> excluded;
  std::function<double(const AppliedEffect&)> choices;  ///< Candidate::choices
};

/// The tally's hypotheses at their places, the same effect at every joint together (what every
/// drive has shows in the sum before it shows in one), and loads from several moments on.
[[nodiscard]] std::vector<Candidate> candidates(const Robot& robot, const BlockFits& fits,
                                                const CandidateRule& rule);

}  // namespace shapeid::diagnosis
