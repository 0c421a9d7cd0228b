// From a recording to a richer model: weights, screening, refits of nonlinear numbers, again until
// nothing changes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/selection.hpp"
#include "shapeid/diagnosis/strangers.hpp"
#include "shapeid/models/body_model.hpp"

namespace shapeid::diagnosis {

struct LoopSettings {
  RowSource rows = ContactTreatment::project;
  BodyModel shapes;            ///< of the free links; where their mass may be
  double expected_mass = 0.0;  ///< M0 > 0, kg, of all free links
  int divisions = 100;         ///< most divisions of the shapes
  Eigen::VectorXd size;        ///< 10 per link: how far parameters may be from the given ones
  Eigen::VectorXd weight;      ///< diagonal of W to begin with; empty: ones
  std::size_t stride = 1;      ///< every how many samples count
  double margin = 0.0;         ///< s between blocks
  double block_seconds = 0.0;  ///< 0: so that there are about forty, and none below half a second
  std::size_t threads = 1;     ///< over logs and hypotheses: nothing depends on how many
  int folds = 8;               ///< of one or two logs; of more, each is one
  std::vector<std::size_t> log_starts;  ///< samples at which a further log begins
  int rounds = 6;                       ///< of weights, screening and refits
  /// The log filtered at a higher cutoff than `cutoff` (Hz), the log's own: what the filter makes
  /// of products is then taken out. Null: the log counts as it is.
  const Recording* rough = nullptr;
  const Recording* rough_reference = nullptr;  ///< likewise of the reference log
  double cutoff = 0.0;
  SelectionRule rule;
};

/// An effect that was found, with what the selection said of it.
struct Found {
  AppliedEffect effect;
  std::string id;
  Eigen::VectorXd standard_error;
  double gain = 0.0, t = 0.0;  ///< of having it, all others in
  std::vector<std::string> ambiguous_with = {};
  /// Of an applied transformation, what beside all that was found last says exactly the same.
  std::vector<std::string> exchangeable = {};
  /// A law without a name that predicts better in its place, though not by more than chance.
  std::optional<Stranger> rival = {};
  /// Its number follows a signal: something is there, but not what the name says.
  std::optional<Variation> varies = {};
  /// It is worth less than the best placebo: laws that no robot has explain as much.
  bool drowned = false;
  /// A ripple that does no better than one over another joint's position, sought likewise.
  bool any_period = false;
  /// It is worth less than all that is unknown on the same joints, effects whose number follows a
  /// signal and laws without a name, and may be a part of that.
  bool beside_unknown = false;
  /// A law without a name predicts better in its place, or leaves it nothing to explain.
  bool displaced = false;
  /// With masses that are bodies it does not differ from zero by what chance may make of none.
  bool faded = false;
  /// It came with the same at other joints, and by itself is no more than chance makes of one of
  /// these.
  bool only_with_others = false;
  /// It is the force of a ground that would have to pull.
  bool pulls = false;
  /// Behind a slower filter it explains hardly any of what it did (doubt_names()).
  bool is_lost_when_slower = false;
  /// Verdict::hangs_on_given
  bool hangs_on_given = false;
  /// Verdict::other_times
  std::vector<When> other_times = {};
  /// Free parameters take it over; without it links of their size would be no bodies.
  bool needed = false;
  /// It is in the model for the sake of bodies, and not for what it predicts.
  [[nodiscard]] bool is_for_bodies_alone() const { return needed && t == 0.0; }
  /// Else it only describes: it predicts, and says nothing about the cause.
  [[nodiscard]] bool name_stands() const {
    return !varies && !drowned && !any_period && !beside_unknown && !displaced && !faded &&
           !only_with_others && !pulls && !is_lost_when_slower && !needed;
  }
};

/// A hypothesis that was looked at, for the ranking.
struct Ranked {
  std::string id;
  double gain = 0.0, t = 0.0;
  bool credible = true;  ///< Scored::credible
};

struct LoopResult {
  RichModel model;  ///< least squares with the prior; not yet a consistent body
  /// What filters the load, of what was found: while causes are sought it must not predict better
  /// by making less noise, as filters do.
  bool filters_to_first_order = true;
  std::vector<Found> found;
  std::vector<Ranked> first_ranking;  ///< beside masses alone
  std::vector<Ranked> last_ranking;   ///< of what was left out
  /// Ids of what can hardly be told from masses and what was found, at any time.
  std::vector<std::string> hidden;
  /// kg: the base's beside constant forces, whose place the accelerometer's noise took for a mass
  /// nearer to the given one.
  std::optional<double> mass_beside_forces;
  std::vector<std::pair<std::string, double>> wrong_signs;  ///< id, its parameter over its error
  std::vector<Stranger> strangers;  ///< laws without a name that explain what is left
  Eigen::VectorXd weight;
  /// Of the log and the reference, by the last round's model; or none.
  std::vector<Eigen::VectorXd> correction, reference_correction;
  double placebo = 0.0;  ///< share of the held-out error that the best law no robot has takes away
  double prior = 1.0;
  /// Held-out, weighted, over samples times dof: of the given model, of rigid links alone, and of
  /// what was found.
  double error_given = 0.0, error_rigid = 0.0, error_end = 0.0;
  std::size_t samples = 0, hypotheses = 0, blocks = 0;  ///< of the log, without the reference's
  double screening_seconds = 0.0, refit_seconds = 0.0;
};

/// `reference` (may be null): an earlier log of the same robot; effects that came since are then
/// hypotheses of their own, payloads among them. Throws Refusal "too-short" for less than eight
/// blocks.
[[nodiscard]] LoopResult close_loop(const Robot& robot, const Recording& log,
                                    const Recording* reference, const LoopSettings& settings);

/// The same, unless the causes of its first search, whose names have not been questioned, ask for
/// other logs: then these are all that is found, and is_closed is false.
struct LoopOrCauses {
  LoopResult result;
  bool is_closed = true;
};
[[nodiscard]] LoopOrCauses close_loop_unless(
    const std::function<bool(const std::vector<Found>&)>& ask_for_other_logs, const Robot& robot,
    const Recording& log, const Recording* reference, const LoopSettings& settings);

}  // namespace shapeid::diagnosis
