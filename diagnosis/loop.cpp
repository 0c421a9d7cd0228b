#include "shapeid/diagnosis/loop.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/best_round.hpp"
#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/exchange.hpp"
#include "shapeid/diagnosis/filter_order.hpp"
#include "shapeid/diagnosis/large_transformation.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/diagnosis/prior.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/refit.hpp"
#include "shapeid/diagnosis/remainders.hpp"
#include "shapeid/diagnosis/take_selection.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Loop {
 public:
  Loop(const Robot& robot, const Recording& log, const Recording* reference,
       const LoopSettings& settings, bool from_usual)
      : state_(robot, log, reference, settings), from_usual_(from_usual) {}

  /// Causes, before their names are questioned.
  void find_causes() {
    try_quarter_turns(state_);
    state_.fit_masses();
    seek_all();
  }

  [[nodiscard]] const LoopResult& causes() const { return result_; }

  /// What these are called, and what is said of them.
  LoopResult run() {
    question_names(state_);
    while (ban_mere_moments()) {
      seek_all();
      question_names(state_);
    }
    add_names_to_first_order(filters_, result_.found);
    for (Found& f : result_.found) {
      std::vector<std::string>& names = f.ambiguous_with;
      names.insert(names.end(), f.exchangeable.begin(), f.exchangeable.end());
      std::sort(names.begin(), names.end());
      names.erase(std::unique(names.begin(), names.end()), names.end());
    }
    compare();
    return std::move(result_);
  }

  /// Whether in some round a search that begins with what is usually fitted came to more.
  [[nodiscard]] bool has_other_way() const { return memory_.has_other_way; }

  /// Whether this predicts better, by what a single law has to gain, with the weights of either.
  [[nodiscard]] bool is_better_than(Loop& other) {
    const Eigen::VectorXd own = result_.weight;
    return std::ranges::all_of(std::array{own, other.result_.weight}, [&](const auto& weight) {
      const Eigen::VectorXd without = other.held_out_with(weight), with = held_out_with(weight);
      return gain_of(without, with).t > limit_for(state_.rule().least_t, with.size());
    });
  }

  /// What another search took is told as well.
  void add_seconds_of(const Loop& other) {
    result_.screening_seconds += other.result_.screening_seconds;
    result_.refit_seconds += other.result_.refit_seconds;
  }

 private:
  [[nodiscard]] Eigen::VectorXd held_out_with(const Eigen::VectorXd& weight) {
    const Eigen::VectorXd own = std::exchange(result_.weight, weight);
    Eigen::VectorXd error = state_.held_out_of_model();
    result_.weight = own;
    return error;
  }

  /// With filters of the load to first order, and once some are found with these as they are.
  void seek_all() {
    seek_until_all_stay();
    if (!result_.filters_to_first_order) return;
    filters_ = filters_among(result_.found);
    if (filters_.empty()) return;
    take_filters_as_they_are(state_);
    seek_until_all_stay();
  }

  void seek_until_all_stay() {
    do {
      seek();
    } while (!all_transformations_stay());
  }

  [[nodiscard]] std::vector<std::string> ids() const {
    std::vector<std::string> list;
    for (const Found& f : result_.found) list.push_back(f.id);
    std::sort(list.begin(), list.end());
    return list;
  }

  /// The given model, and rigid links alone, beside what was found: without any effect applied,
  /// with the last weights, of the log with what the filter did to the found model taken out.
  void compare() {
    result_.error_end = state_.held_out_of_log().sum();
    const RichModel found = result_.model;
    result_.model.effects.clear();
    const BlockFits plain = state_.tallied({});
    result_.model = found;
    result_.error_given = plain.given_error().tail(plain.log_blocks()).sum();
    result_.error_rigid = plain.held_out({state_.masses}).tail(plain.log_blocks()).sum();
    const auto& blocks = plain.tally().blocks;
    result_.blocks = static_cast<std::size_t>(plain.log_blocks());
    result_.samples = 0;
    for (std::size_t b = plain.first_block(); b < blocks.size(); ++b) {
      result_.samples += blocks[b].samples;
    }
    const double rows =
        static_cast<double>(result_.samples) * static_cast<double>(state_.robot.dof());
    for (double* error : {&result_.error_given, &result_.error_rigid, &result_.error_end}) {
      *error /= rows;
    }
  }

  /// Effects, until nothing changes. Weights follow from the effects and effects from the weights,
  /// which need not come to an end: then that of all rounds counts that predicts best.
  void seek() {
    std::vector<LoopResult> rounds;
    remainders_.clear();
    for (round_ = 0; round_ < state_.settings.rounds; ++round_) {
      const std::vector<std::string> before = ids();
      state_.correct();
      state_.reweigh();
      auto start = std::chrono::steady_clock::now();
      screen();
      result_.screening_seconds += seconds_since(start);
      start = std::chrono::steady_clock::now();
      refit(state_);
      prune_transformations();
      result_.refit_seconds += seconds_since(start);
      if (round_ > 0 && ids() == before) {
        rounds.clear();
        break;
      }
      if (round_ > 0) rounds.push_back(result_);
    }
    if (!rounds.empty()) {
      const std::size_t taken = take_best_of(rounds, state_);
      if (taken + 1 < rounds.size()) large_.reset();  // it is the last round's
    }
    try_large_transformations();
    leave_out_remainders();
    seek_long_ripples();
    try_noise_for_weight();
  }

  /// Without laws that only make up for the shape of another; what is said of the others is asked
  /// anew.
  void leave_out_remainders() {
    const auto start = std::chrono::steady_clock::now();
    while (const std::optional<AppliedEffect> left_out = leave_out_remainder(state_)) {
      remainders_.push_back(*left_out);
      screen();
      refit(state_);
      prune_transformations();
    }
    result_.refit_seconds += seconds_since(start);
  }

  /// Where the residual has most of a ripple says little of its period if the joint goes through
  /// hardly more than one: the others are offset and slope, which masses have, too. Once all else
  /// is found it is sought from half to twice of what it is, and taken if that predicts better.
  void seek_long_ripples() {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < result_.found.size(); ++i) {
      if (!is_long_ripple(state_.log, result_.found[i].effect)) continue;
      const LoopResult before = result_;
      const Eigen::VectorXd error = state_.held_out_of_model();
      refit_from_afar(state_, i);
      if (!(gain_of(error, state_.held_out_of_model()).t > keep_t)) result_ = before;
    }
    result_.refit_seconds += seconds_since(start);
  }

  [[nodiscard]] std::vector<Candidate> listed(const BlockFits& fits) const {
    CandidateRule rule;
    rule.free_links = state_.settings.shapes.free_links;
    rule.has_reference = state_.reference.has_value();
    // The derivative of a transformation needs a model that is not wrong by other things.
    rule.transformations = round_ > 0;
    rule.excluded = [this](const AppliedEffect& h) {
      return state_.is_applied_transformation(h) || is_banned(h) ||
             (moments_describe_ > 1 && h.begins()) || rests(h);
    };
    rule.choices = [this](const AppliedEffect& h) { return periods_told_apart(state_.log, h); };
    return candidates(state_.robot, fits, rule);
  }

  /// Whether it is a ripple of a joint that moves in none of the logs in which it acts.
  [[nodiscard]] bool rests(const AppliedEffect& h) const {
    const auto& reference = state_.reference;
    return (!h.acts_in_log() || is_ripple_at_rest(state_.log, h)) &&
           (!h.acts_in_reference() || !reference || is_ripple_at_rest(*reference, h));
  }

  void screen() {
    BlockFits fits = state_.tallied(screened_hypotheses(state_.robot, result_.model,
                                                        {state_.log, state_.left_by(result_.model)},
                                                        state_.rest_of_reference(result_.model)));
    const Term fixed = state_.always(fits.tally());
    const std::vector<Candidate> list = listed(fits);
    // From the beginning each time: what was accepted with worse weights has to prove itself again.
    SelectionRule rule = state_.rule();
    rule.contained_too = masses_want_more(fits, {fixed}, rule.least_t);
    // Once there is another way this one is gone to its end without looking for it.
    rule.from_usual = from_usual_             ? FromUsual::taken
                      : memory_.has_other_way ? FromUsual::not_asked
                                              : FromUsual::noted;
    const Selection selection = select(fits, fixed, list, rule);
    memory_.has_other_way = memory_.has_other_way || selection.usual_is_better;
    large_ = large_transformation(fits, fixed, list, selection);
    result_.prior = choose_prior(fits, chosen_terms(fixed, list, selection));
    take_selection(fits, fixed, list, selection, state_);
    note_exchangeable(fits, fixed, list, selection, state_);
    if (result_.first_ranking.empty()) note_first_ranking(list, selection, result_);
  }

  /// What a large transformation leaves of its derivative looks like further effects. So one that
  /// would explain much by itself is applied alone, exactly, and the others are sought beside it;
  /// once more, if then another would. That stays if it needs fewer effects and predicts no worse.
  void try_large_transformations() {
    if (!large_ || result_.found.size() < 2) return;
    const LoopResult several = result_;
    const Memory memory = memory_;
    const Eigen::VectorXd error = state_.held_out_of_model();
    const auto start = std::chrono::steady_clock::now();
    std::vector<Found> applied;
    bool simpler = false;
    constexpr std::size_t most = 2;
    while (large_ && !simpler && applied.size() < most) {
      applied.push_back(
          {large_->effect, large_->term.id, Eigen::VectorXd::Zero(large_->effect.value.size())});
      result_.found = applied;
      state_.collect_effects();
      refit(state_);
      applied = result_.found;
      screen();
      refit(state_);
      prune_transformations();
      simpler = result_.found.size() < several.found.size() &&
                !(gain_of(state_.held_out_of_model(), error).t > not_worse_t);
    }
    if (!simpler) {
      result_ = several;
      memory_ = memory;
    }
    result_.refit_seconds += seconds_since(start);
  }

  /// Weight and inertia are of one mass. Noise of the accelerometer makes the one that accelerates
  /// too small; constant forces, near the base, then stand for the weight that is missing, and with
  /// more numbers than the noise has they predict a little better. So if the base has less than
  /// half of its given mass, the noise is tried, exactly, in the place of all forces, also if it is
  /// in already. It stays if it predicts, and the base then has a mass that is nearer to the given
  /// one.
  void try_noise_for_weight() {
    constexpr double hardly_any = 0.5;
    constexpr int base = 0;
    const auto& free = state_.settings.shapes.free_links;
    const bool sought = std::count(free.begin(), free.end(), base) > 0;
    const double off_by = state_.mass_off_by(base);
    const double mass = result_.model.Phi[Eigen::Index{10} * base];
    if (state_.robot.root != Root::floating || !sought ||
        !(mass < hardly_any * state_.robot.links[base].inertia.mass())) {
      return;
    }
    const AppliedEffect noise = at_start(*find_effect("accel_noise"), base);
    const Effect& force = *find_effect("external_force");
    const auto is_force = [&](const Found& f) { return f.effect.effect == &force; };
    const bool has_noise = has_place_of(state_.result.model.effects, noise);
    const bool has_force = std::any_of(result_.found.begin(), result_.found.end(), is_force);
    if (is_banned(noise) || (has_noise && !has_force)) return;
    const LoopResult before = result_;
    const Memory memory = memory_;
    const auto start = std::chrono::steady_clock::now();
    for (int link = 0; link < state_.robot.link_count(); ++link) {
      memory_.forces.push_back(at_start(force, link));
    }
    std::erase_if(result_.found, is_force);
    if (!has_noise) {
      result_.found.push_back({noise, "accel_noise@base.accel", Eigen::VectorXd::Zero(1)});
    }
    state_.collect_effects();
    refit(state_);
    screen();
    refit(state_);
    prune_transformations();
    const bool better =
        has_place_of(result_.model.effects, noise) && state_.mass_off_by(base) < off_by;
    if (better) {
      result_.mass_beside_forces = mass;
    } else {
      result_ = before;
      memory_ = memory;
    }
    result_.refit_seconds = before.refit_seconds + seconds_since(start);
  }

  [[nodiscard]] static std::vector<Term> chosen_terms(const Term& fixed,
                                                      const std::vector<Candidate>& list,
                                                      const Selection& selection) {
    std::vector<Term> terms = {fixed};
    for (const Verdict& v : selection.accepted) terms.push_back(list[v.candidate].term);
    return terms;
  }

  /// What began at a moment and is no load describes this log alone: on other motion nothing begins
  /// then. Whether there was any; it is not looked for again. If others come in its place, none is:
  /// each would cost a search of its own.
  [[nodiscard]] bool ban_mere_moments() {
    const std::size_t before = memory_.banned.size();
    for (const Found& f : result_.found) {
      if (f.effect.begins() && !f.name_stands()) memory_.banned.push_back(f.effect);
    }
    if (memory_.banned.size() == before) return false;
    moments_describe_ += 1;
    return true;
  }

  /// A refit that ends at the limit found no value that is believed.
  [[nodiscard]] bool at_limit(const AppliedEffect& a) const {
    return over_limit(*a.effect, a.value, state_.rule().most_force) >= 1.0;
  }

  /// Applied transformations that no longer lower the held-out error, or are of no credible size,
  /// are taken back for good, the least first. That is asked of derivatives: what gains little is
  /// small, and sums of the log without each would be most of the time that many take. But beside a
  /// derivative masses still have the rows that it has changed, and about an upright axis they feel
  /// weight by a tilt alone: what is to go is asked once more as it is, unless the base turns.
  void prune_transformations() {
    std::vector<AppliedEffect> stay;
    while (std::any_of(result_.found.begin(), result_.found.end(),
                       [](const Found& f) { return f.effect.effect->transform.any(); })) {
      const std::vector<Gain> gains = state_.gains_by_derivative();
      std::optional<std::size_t> worst;
      for (std::size_t i = 0; i < gains.size(); ++i) {
        const Found& f = result_.found[i];
        if (!f.effect.effect->transform.any() || has_place_of(stay, f.effect)) continue;
        if (is_worth(gains[i]) && !at_limit(f.effect)) continue;
        if (!worst || gains[i].t < gains[*worst].t) worst = i;
      }
      if (!worst) return;
      const bool asked_again =
          state_.robot.root == Root::fixed && !at_limit(result_.found[*worst].effect);
      if (asked_again && is_worth(state_.gain_as_it_is(*worst, state_.held_out_either_way()))) {
        stay.push_back(result_.found[*worst].effect);
      } else {
        take_back(*worst, is_worth(gains[*worst]));
      }
    }
  }

  [[nodiscard]] static bool is_worth(const Gain& gain) {
    return gain.t > keep_t && gain.share > 0.0;
  }

  /// If it is `worth` having and of no credible size, it may come in once more: beside what is
  /// found later it may be of another size.
  void take_back(std::size_t i, bool worth = false) {
    if (result_.found[i].effect.effect == find_effect("accel_noise")) {
      result_.mass_beside_forces.reset();
      memory_.forces.clear();
    }
    const AppliedEffect& effect = result_.found[i].effect;
    const bool once_more = worth && !has_place_of(memory_.too_large, effect);
    (once_more ? memory_.too_large : memory_.banned).push_back(effect);
    result_.found.erase(result_.found.begin() + static_cast<std::ptrdiff_t>(i));
    state_.collect_effects();
  }

  /// Notes what is lost without each of the applied transformations, as it is and not by its
  /// derivative. The first that is not worth it is taken back, and false returned: what was found
  /// beside it, and in its place, is to be sought again.
  [[nodiscard]] bool all_transformations_stay() {
    std::optional<LoopState::HeldOut> with;
    for (std::size_t i = 0; i < result_.found.size(); ++i) {
      if (!result_.found[i].effect.effect->transform.any()) continue;
      if (!with) with = state_.held_out_either_way();
      const Gain gain = state_.gain_as_it_is(i, *with);
      result_.found[i].gain = gain.share;
      result_.found[i].t = gain.t;
      if (is_worth(gain)) continue;
      take_back(i);
      return false;
    }
    return true;
  }

  [[nodiscard]] bool is_banned(const AppliedEffect& h) const {
    const auto has_place = [&h](const AppliedEffect& force) {
      return force.effect == h.effect && force.site == h.site;
    };
    return has_place_of(memory_.banned, h) || has_place_of(remainders_, h) ||
           std::any_of(memory_.forces.begin(), memory_.forces.end(), has_place);
  }

  /// What is not sought any more, and what else a way that is not gone must not leave behind.
  struct Memory {
    std::vector<AppliedEffect> banned;
    std::vector<AppliedEffect> too_large;  ///< taken back once, of no credible size
    std::vector<AppliedEffect> forces;     ///< whose place the accelerometer's noise has taken
    bool has_other_way = false;
  };

  LoopState state_;
  LoopResult& result_ = state_.result;
  bool from_usual_;
  Memory memory_;
  std::vector<Found> filters_;             ///< of the load, as found to first order
  std::vector<AppliedEffect> remainders_;  ///< of other laws' shapes, in this search
  std::optional<Candidate> large_;
  int round_ = 0;
  int moments_describe_ = 0;  ///< searches in which moments came in that are no loads
};

}  // namespace

LoopResult close_loop(const Robot& robot, const Recording& log, const Recording* reference,
                      const LoopSettings& settings) {
  const auto never = [](const std::vector<Found>&) { return false; };
  return close_loop_unless(never, robot, log, reference, settings).result;
}

LoopOrCauses close_loop_unless(
    const std::function<bool(const std::vector<Found>&)>& ask_for_other_logs, const Robot& robot,
    const Recording& log, const Recording* reference, const LoopSettings& settings) {
  Loop loop(robot, log, reference, settings, false);
  loop.find_causes();
  if (ask_for_other_logs(loop.causes().found)) return {loop.causes(), false};
  if (!loop.has_other_way()) return {loop.run()};
  // Weights follow from what is found, so the other way is gone to its end before both are
  // compared: what is better in a round need not be better in the end.
  Loop other(robot, log, reference, settings, true);
  other.find_causes();
  const bool is_better = other.is_better_than(loop);
  Loop& taken = is_better ? other : loop;
  taken.add_seconds_of(is_better ? loop : other);
  return {taken.run()};
}

}  // namespace shapeid::diagnosis
