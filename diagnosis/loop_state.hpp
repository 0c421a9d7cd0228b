// What the loop has come to: the present model and what was found, and sums of logs as it sees
// them.
#pragma once

#include <optional>
#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

struct LoopState {
  /// Refers to all but the logs.
  LoopState(const Robot& robot, const Recording& log, const Recording* reference,
            const LoopSettings& settings);

  const Robot& robot;
  Recording log;
  std::optional<Recording> reference;
  const LoopSettings& settings;
  Eigen::VectorXd centre;   ///< of the prior, 10 per link
  Term masses;              ///< columns of the free links
  std::vector<int> silent;  ///< joints without torque (silent_joints())
  TallyOptions tally_options;
  RichModel rigid;  ///< masses alone, as fitted before anything was sought
  LoopResult result;

  /// Sums of the hypotheses and of modulations of these, beside the present model. Throws Refusal
  /// "too-short".
  [[nodiscard]] BlockFits tallied(const std::vector<AppliedEffect>& hypotheses,
                                  const std::vector<Modulation>& modulations = {});
  /// The given prior's strength, and masses alone.
  void fit_masses();
  /// What the filter makes of products, by the present model: of the log and the reference from now
  /// on.
  void correct();
  /// W = 1 / variance of what the present model leaves, row by row. The row of a joint that nothing
  /// drives weighs no more than that of any that is driven: links without mass would leave nothing
  /// there.
  void reweigh();
  /// Of the log and the reference from now on, and noted in the result.
  void use_correction(const std::vector<Eigen::VectorXd>& of_log,
                      const std::vector<Eigen::VectorXd>& of_reference = {});
  /// What a model leaves of the log.
  [[nodiscard]] Series left_by(const RichModel& model) const;
  /// The reference log, if there is one, and what a model leaves of it.
  [[nodiscard]] std::optional<Rest> rest_of_reference(const RichModel& model) const;
  /// The model's effects from what was found; transformations are kept within their limits.
  void collect_effects();
  /// The settings' rule, for this robot: no constant force exceeds its weight.
  [[nodiscard]] SelectionRule rule() const;
  /// The factor by which the link's mass, as the free number that it is in the search, is too large
  /// or too small beside the given one; infinity if it is none.
  [[nodiscard]] double mass_off_by(int link) const;
  /// From a fit whose first term is the masses.
  void set_masses(const Fit& fit);

  [[nodiscard]] bool is_applied_transformation(const AppliedEffect& effect) const;
  /// Masses and the changes of transformations that are applied already: fitted along always.
  [[nodiscard]] Term always(const Tally& tally) const;
  /// always(), and those of the first `effects` hypotheses of a tally, the present effects, that
  /// are columns.
  [[nodiscard]] std::vector<Term> terms_of_model(const BlockFits& fits, std::size_t effects) const;
  /// Held-out error of the present effects, linear numbers refitted.
  [[nodiscard]] Eigen::VectorXd held_out_of_model();
  /// The same of the log's blocks alone.
  [[nodiscard]] Eigen::VectorXd held_out_of_log();

  /// The same twice: with applied transformations moved on by a step on the blocks that are fitted,
  /// as above, which hides that a value has run away; and with them held at their values.
  struct HeldOut {
    Eigen::VectorXd moved_on, as_written;
  };
  [[nodiscard]] HeldOut held_out_either_way();
  /// Of each that was found what it gains, all others in.
  [[nodiscard]] std::vector<Gain> gains();
  /// The same of number `i`, an applied transformation, as it is and not by its derivative; `with`
  /// is the held-out error of all. A value that steps have led away, so that it does harm as it is,
  /// is worth as much.
  [[nodiscard]] Gain gain_as_it_is(std::size_t i, const HeldOut& with);
  /// Of each effect that is an applied transformation what it gains, all others in, as far as its
  /// derivative tells: its numbers go back to zero as if the rows were linear in them.
  [[nodiscard]] std::vector<Gain> gains_by_derivative();
};

}  // namespace shapeid::diagnosis
