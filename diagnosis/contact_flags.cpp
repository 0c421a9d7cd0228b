#include "shapeid/diagnosis/contact_flags.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects/contact_parts.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/models/mean.hpp"
#include "shapeid/reference/standing_feet.hpp"

namespace shapeid::diagnosis {
namespace {

/// For which times the force is looked for, s: from three readings of a fast log to a step.
constexpr std::array times = {0.006, 0.009, 0.0135, 0.02, 0.03, 0.045, 0.07, 0.1};
/// A contact's force begins and ends softly, and filters make it softer.
constexpr double beyond = 1.2;

/// A force that is there for `T` s, and one that fades in a straight line over them.
Eigen::MatrixXd within(const Instant& at, int contact, double away, double T) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(at.robot.dof(), 6);
  if (!(away <= T + time_rounding)) return columns;
  columns.leftCols<3>() = force_columns(at, contact, false);
  columns.rightCols<3>() = (1.0 - away / T) * columns.leftCols<3>();
  return columns;
}
Eigen::MatrixXd before(const Instant& at, int contact, const Eigen::VectorXd& shape) {
  return within(at, contact, at.surroundings.until_touch[contact], shape[0]);
}
Eigen::MatrixXd after(const Instant& at, int contact, const Eigen::VectorXd& shape) {
  return within(at, contact, at.surroundings.since_touch[contact], shape[0]);
}
/// Over the time that it is there.
Eigen::Vector3d mean_force(const Eigen::VectorXd& value) {
  return value.head<3>() + 0.5 * value.tail<3>();
}

/// An effect of the catalogue as the force that stands for it while it is sought.
Effect as_force(const char* id,
                Eigen::MatrixXd (*columns)(const Instant&, int, const Eigen::VectorXd&)) {
  Effect force = *find_effect(id);
  force.transform = {};
  force.columns = columns;
  force.parameters = contact_force_parameters();
  for (const Parameter& fading : contact_force_parameters()) force.parameters.push_back(fading);
  force.shape = {{"T", "s", times.front(), times.back(), times.front()}};
  return force;
}

Effect late_force() { return as_force("contact_late", before); }
Effect short_force() { return as_force("contact_short", after); }

class Search {
 public:
  Search(const Robot& robot, const Recording& log, const Recording* reference,
         const LoopSettings& settings)
      : state_(robot, log, reference, settings) {}

  /// The strongest of them that was not corrected before, if it is accepted among the first,
  /// beside these.
  [[nodiscard]] std::optional<Found> strongest(const std::vector<Found>& before) {
    state_.fit_masses();
    state_.correct();
    state_.reweigh();
    const BlockFits fits = state_.tallied(hypotheses());
    CandidateRule rule;
    rule.free_links = state_.settings.shapes.free_links;
    rule.several_shapes = true;  // one for each time
    rule.has_reference = false;  // flags are the sensor's: nothing that came since
    rule.excluded = [](const AppliedEffect&) { return false; };
    rule.choices = [this](const AppliedEffect& h) { return periods_told_apart(state_.log, h); };
    const std::vector<Candidate> list = candidates(state_.robot, fits, rule);
    SelectionRule few = state_.rule();
    constexpr int first = 6;
    few.most_terms = std::min(few.most_terms, first);
    const Selection selection = select(fits, state_.masses, list, few);
    std::optional<Found> found;
    Eigen::Index column = std::ssize(state_.masses.columns);
    for (const Verdict& v : selection.accepted) {
      const Candidate& c = list[v.candidate];
      const Eigen::VectorXd value = selection.fit.value.segment(column, std::ssize(c.term.columns));
      column += value.size();
      if (!is_flag(c.effect) || !pushes(state_.log, mean_force(value)) ||
          (found && found->gain >= v.gain))
        continue;
      if (std::any_of(before.begin(), before.end(),
                      [&](const Found& f) { return f.id == c.term.id; })) {
        continue;
      }
      const double T = beyond * c.effect.shape[0];
      AppliedEffect effect = at_start(*find_effect(c.effect.effect->id), c.effect.site);
      effect.value = Eigen::VectorXd::Constant(1, T);
      if (swings(state_.robot, state_.log, effect)) continue;
      const double step = 0.5 * (times[1] / times[0] - 1.0) * T;
      found.emplace(Found{effect, c.term.id, Eigen::VectorXd::Constant(1, step), v.gain, v.t});
    }
    return found;
  }

 private:
  [[nodiscard]] bool is_flag(const AppliedEffect& a) const {
    return a.effect == &late_ || a.effect == &short_;
  }

  [[nodiscard]] std::vector<AppliedEffect> hypotheses() const {
    std::vector<AppliedEffect> list =
        screened_hypotheses(state_.robot, state_.result.model,
                            {state_.log, state_.left_by(state_.result.model)}, std::nullopt);
    for (int contact = 0; contact < site_count(state_.robot, SiteKind::contact); ++contact) {
      for (const Effect* effect : {&late_, &short_}) {
        for (const double T : times) {
          list.push_back(at_start(*effect, contact));
          list.back().shape[0] = T;
        }
      }
    }
    return list;
  }

  LoopState state_;
  Effect late_ = late_force(), short_ = short_force();
};

}  // namespace

bool has_contact_flags(const Recording& log, const LoopSettings& settings) {
  return !log.samples().empty() && !log[0].in_contact.empty() &&
         settings.rows.contacts == ContactTreatment::project;
}

std::optional<Gain> gain_beside(const Robot& robot, const Recording& log,
                                const Recording* reference, const LoopSettings& settings,
                                const LoopResult& loop, const Found& flag) {
  LoopState state(robot, log, reference, settings);
  state.result = loop;
  state.correct();
  const Effect force =
      flag.effect.effect == find_effect("contact_late") ? late_force() : short_force();
  std::vector<AppliedEffect> effects = state.result.model.effects;
  effects.push_back(at_start(force, flag.effect.site));
  effects.back().shape[0] = flag.effect.value[0] / beyond;
  const BlockFits fits = state.tallied(effects);
  std::vector<Term> terms = state.terms_of_model(fits, effects.size() - 1);
  const Eigen::VectorXd without = fits.held_out(terms);
  terms.push_back(term_of(robot, fits.tally(), effects.size() - 1));
  const Gain gain = gain_of(without, fits.held_out(terms));
  return gain.t > state.rule().least_t ? std::optional(gain) : std::nullopt;
}

bool pushes(const Recording& log, const Eigen::Vector3d& force) {
  Eigen::Vector3d down = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < log.samples().size(); ++i) down += log.down(i);
  return force.dot(down) < 0.0;
}

bool swings(const Robot& robot, const Recording& log, const AppliedEffect& flag) {
  // As that of "contact-labels" (reference/standing_feet.hpp).
  constexpr double alike = 0.7;
  const bool late = flag.effect == find_effect("contact_late");
  Mean said_to_touch, in_the_air;  // (m/s)^2
  for (const std::size_t i : log.usable(log.stride_of(20000))) {
    const Sample& sample = log[i];
    if (std::ranges::find(sample.in_contact, true) == sample.in_contact.end()) continue;
    const reference::ContactMotions feet = reference::against_stance(robot, sample);
    const Surroundings at = log.surroundings(i);
    for (Eigen::Index foot = 0; foot < feet.place.cols(); ++foot) {
      if (sample.in_contact[static_cast<std::size_t>(foot)]) continue;
      const Eigen::Vector3d velocity =
          sample.base_angular_velocity.cross(feet.place.col(foot)) + feet.velocity.col(foot);
      const double away = (late ? at.until_touch : at.since_touch)[foot];
      const bool touches = foot == flag.site && away <= flag.value[0];
      (touches ? said_to_touch : in_the_air).add(velocity.squaredNorm());
    }
  }
  return in_the_air.count > 0 && said_to_touch.value() > alike * alike * in_the_air.value();
}

void correct_contact_flags(Recording& log, const std::vector<Found>& found) {
  for (const Found& f : found) {
    const double T = f.effect.value[0];
    const bool late = f.effect.effect == find_effect("contact_late");
    log.lengthen_contact(f.effect.site, late ? T : 0.0, late ? 0.0 : T);
  }
}

std::vector<Found> correct_contact_flags(const Robot& robot, Recording& log, Recording* reference,
                                         const std::vector<Recording*>& along,
                                         const LoopSettings& settings) {
  std::vector<Found> all;
  if (!has_contact_flags(log, settings)) return all;
  const auto most = 2 * robot.contacts.size();  // each begins and ends
  while (all.size() < most) {
    const std::optional<Found> found = Search(robot, log, reference, settings).strongest(all);
    if (!found) break;
    all.push_back(*found);
    correct_contact_flags(log, {*found});
    if (reference != nullptr) correct_contact_flags(*reference, {*found});
    for (Recording* other : along) {
      if (other != nullptr) correct_contact_flags(*other, {*found});
    }
  }
  return all;
}

}  // namespace shapeid::diagnosis
