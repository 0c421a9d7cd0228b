#include "shapeid/diagnosis/loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/filter_error.hpp"
#include "shapeid/diagnosis/placebo.hpp"
#include "shapeid/diagnosis/prior.hpp"
#include "shapeid/diagnosis/refine.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::diagnosis {
namespace {

// Errors closer than this many standard errors of their difference are not told apart.
constexpr double not_worse_t = 2.0;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Loop {
 public:
  Loop(const Robot& robot, const Recording& log, const Recording* reference,
       const LoopSettings& settings)
      : robot_(robot), log_(log), reference_(reference), settings_(settings) {
    centre_ = stacked_parameters(robot);
    result_.model.Phi = centre_;
    result_.weight = settings.weight.size() > 0
                         ? settings.weight
                         : Eigen::VectorXd(Eigen::VectorXd::Ones(robot.dof()));
    tally_options_.stride = settings.stride;
    tally_options_.margin = settings.margin;
    tally_options_.block_seconds = settings.block_seconds;
    if (tally_options_.block_seconds <= 0.0) {
      constexpr double wanted_blocks = 40.0, shortest = 0.5;
      tally_options_.block_seconds = std::max(shortest, log.duration() / wanted_blocks);
    }
    masses_.id = "masses";
    for (const int link : settings.shapes.free_links) {
      for (Eigen::Index p = 0; p < 10; ++p) masses_.columns.push_back(10 * link + p);
    }
    masses_.nonnegative.assign(masses_.columns.size(), false);
  }

  LoopResult run() {
    fit_masses();
    for (round_ = 0; round_ < settings_.rounds; ++round_) {
      const std::vector<std::string> before = ids();
      correct();
      reweigh();
      auto start = std::chrono::steady_clock::now();
      screen();
      result_.screening_seconds += seconds_since(start);
      start = std::chrono::steady_clock::now();
      refit();
      prune_transformations();
      result_.refit_seconds += seconds_since(start);
      if (round_ > 0 && ids() == before) break;
    }
    try_large_transformation();
    question_names();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<std::string> ids() const {
    std::vector<std::string> list;
    for (const Found& f : result_.found) list.push_back(f.id);
    std::sort(list.begin(), list.end());
    return list;
  }

  [[nodiscard]] BlockFits tallied(const std::vector<AppliedEffect>& hypotheses,
                                  const std::vector<Modulation>& modulations = {}) {
    Tally tally = empty_tally(robot_, hypotheses, modulations);
    tally_options_.weight = result_.weight;
    if (reference_ != nullptr) {
      RichModel earlier = result_.model;
      std::erase_if(earlier.effects, [&](const AppliedEffect& a) { return came_since(a); });
      add_to_tally(tally, robot_, settings_.contacts, earlier, *reference_, tally_options_, true);
    }
    add_to_tally(tally, robot_, settings_.contacts, result_.model, log_, tally_options_, false);
    constexpr std::size_t fewest_blocks = 8;
    if (tally.blocks.size() < fewest_blocks) {
      throw Refusal("too-short",
                    fmt::format("the log gives {} blocks of {:.2g} s to hold out, at least {} are "
                                "needed",
                                tally.blocks.size(), tally_options_.block_seconds, fewest_blocks));
    }
    BlockFits fits(std::move(tally), centre_, settings_.size, settings_.folds);
    fits.set_prior(result_.prior);
    return fits;
  }

  [[nodiscard]] bool came_since(const AppliedEffect& a) const {
    return std::any_of(result_.found.begin(), result_.found.end(), [&](const Found& f) {
      return f.since_reference && same_place(f.effect, a);
    });
  }

  void set_masses(const Fit& fit) {
    result_.model.Phi = centre_;
    for (std::size_t i = 0; i < masses_.columns.size(); ++i) {
      result_.model.Phi[masses_.columns[i]] += fit.value[static_cast<Eigen::Index>(i)];
    }
  }

  void fit_masses() {
    BlockFits fits = tallied({});
    result_.prior = choose_prior(fits, {masses_});
    set_masses(fits.fit({masses_}));
  }

  /// What the filter makes of products, by the present model.
  void correct() {
    if (settings_.rough == nullptr) return;
    const Viewer viewer(robot_, settings_.contacts, result_.model.effects);
    result_.correction =
        filter_error(viewer, result_.model, log_, *settings_.rough, settings_.cutoff);
    log_.set_correction(result_.correction);
  }

  /// W = 1 / variance of what the present model leaves, row by row.
  void reweigh() {
    const Eigen::VectorXd rms =
        series(robot_, settings_.contacts, result_.model, log_, settings_.stride).rms();
    // A row that fits far better than the others would otherwise be fitted to its last digit.
    constexpr double least_share = 0.02;
    const double floor = std::max(least_share * rms.mean(), 1e-12);
    result_.weight = rms.cwiseMax(floor).cwiseAbs2().cwiseInverse();
  }

  [[nodiscard]] std::vector<Candidate> listed(const BlockFits& fits) const {
    CandidateRule rule;
    rule.free_links = settings_.shapes.free_links;
    rule.has_reference = reference_ != nullptr;
    // The derivative of a transformation needs a model that is not wrong by other things.
    rule.transformations = round_ > 0;
    rule.excluded = [this](const AppliedEffect& h) {
      return is_applied_transformation(h) || is_banned(h);
    };
    rule.came_since = [this](const AppliedEffect& h) { return came_since(h); };
    rule.choices = [this](const AppliedEffect& h) { return periods_told_apart(log_, h); };
    return candidates(robot_, fits, rule);
  }

  [[nodiscard]] bool is_applied_transformation(const AppliedEffect& h) const {
    return h.effect->transform.any() &&
           std::any_of(result_.model.effects.begin(), result_.model.effects.end(),
                       [&](const AppliedEffect& a) { return same_place(a, h); });
  }

  /// Masses and the changes of transformations that are applied already: fitted along always.
  [[nodiscard]] Term always(const Tally& tally) const {
    Term term = masses_;
    for (std::size_t k = 0; k < tally.hypotheses.size(); ++k) {
      if (!is_applied_transformation(tally.hypotheses[k])) continue;
      const Term change = term_of(robot_, tally, k);
      term.columns.insert(term.columns.end(), change.columns.begin(), change.columns.end());
    }
    term.nonnegative.assign(term.columns.size(), false);
    return term;
  }

  void screen() {
    BlockFits fits = tallied(screened_hypotheses(
        robot_, result_.model, log_,
        series(robot_, settings_.contacts, result_.model, log_, settings_.stride)));
    const Term fixed = always(fits.tally());
    const std::vector<Candidate> list = listed(fits);
    // From the beginning each time: what was accepted with worse weights has to prove itself again.
    const Selection selection = select(fits, fixed, list, settings_.rule);
    note_large_transformation(fits, fixed, list, selection);
    result_.prior = choose_prior(fits, chosen_terms(fixed, list, selection));
    take(fits, fixed, list, selection);
  }

  /// The transformation that, as its derivative, takes away most of what all that was accepted
  /// does, alone or beside the strongest of these, if there is one.
  void note_large_transformation(const BlockFits& fits, const Term& fixed,
                                 const std::vector<Candidate>& list, const Selection& selection) {
    large_.reset();
    if (selection.accepted.size() < 2) return;
    const auto strongest = std::max_element(
        selection.accepted.begin(), selection.accepted.end(),
        [](const Verdict& one, const Verdict& other) { return one.gain < other.gain; });
    for (const std::vector<Term>& beside :
         {std::vector<Term>{fixed}, std::vector<Term>{fixed, list[strongest->candidate].term}}) {
      if (large_) return;
      constexpr double most = 0.5;
      const double before = fits.held_out(beside).sum();
      double least = before - most * (before - selection.error_end.sum());
      for (std::size_t k = 0; k < list.size(); ++k) {
        const Candidate& c = list[k];
        const bool accepted = std::any_of(selection.accepted.begin(), selection.accepted.end(),
                                          [&](const Verdict& v) { return v.candidate == k; });
        if (!c.effect.effect->transform.any() || c.since_reference || accepted) continue;
        std::vector<Term> with = beside;
        with.push_back(c.term);
        const double error = fits.held_out(with).sum();
        if (error >= least) continue;
        least = error;
        large_ = c;
      }
    }
  }

  /// What a large transformation leaves of its derivative looks like further effects. So one that
  /// would explain most by itself is applied alone, exactly, and the others are sought beside it.
  /// That stays if it needs fewer effects and predicts no worse.
  void try_large_transformation() {
    if (!large_ || result_.found.size() < 2) return;
    const LoopResult several = result_;
    const Eigen::VectorXd error = held_out_of_model();
    const auto start = std::chrono::steady_clock::now();
    result_.found = {
        Found{large_->effect, large_->term.id, Eigen::VectorXd::Zero(large_->effect.value.size())}};
    collect_effects();
    refit();
    screen();
    refit();
    prune_transformations();
    const bool simpler = result_.found.size() < several.found.size() &&
                         !(gain_of(held_out_of_model(), error).t > not_worse_t);
    if (!simpler) result_ = several;
    result_.refit_seconds += seconds_since(start);
  }

  [[nodiscard]] static std::vector<Term> chosen_terms(const Term& fixed,
                                                      const std::vector<Candidate>& list,
                                                      const Selection& selection) {
    std::vector<Term> terms = {fixed};
    for (const Verdict& v : selection.accepted) terms.push_back(list[v.candidate].term);
    return terms;
  }

  /// An applied transformation that no longer lowers the held-out error is taken back for good.
  void prune_transformations() {
    for (std::size_t i = 0; i < result_.found.size();) {
      if (!result_.found[i].effect.effect->transform.any()) {
        ++i;
        continue;
      }
      const Eigen::VectorXd with = held_out_of_model();
      const std::vector<Found> all = result_.found;
      result_.found.erase(result_.found.begin() + static_cast<std::ptrdiff_t>(i));
      collect_effects();
      const Gain gain = gain_of(held_out_of_model(), with);
      if (gain.t > keep_t && gain.share > 0.0) {
        result_.found = all;
        result_.found[i].gain = gain.share;
        result_.found[i].t = gain.t;
        collect_effects();
        ++i;
      } else {
        banned_.push_back(all[i].effect);
      }
    }
  }

  /// Sums of the present effects, placebos and laws without a name, and products of all of these.
  struct Questions {
    BlockFits fits;
    std::vector<Term> terms;  ///< masses and effects
    std::size_t effects = 0, first_carrier = 0;
  };
  [[nodiscard]] Questions questions() {
    std::vector<AppliedEffect> all = result_.model.effects;
    const std::size_t effects = all.size();
    for (const AppliedEffect& placebo : placebos(robot_)) all.push_back(placebo);
    const std::size_t first_carrier = all.size();
    for (const AppliedEffect& a : carriers(robot_, result_.model.effects)) all.push_back(a);
    std::vector<Modulation> products = modulations(robot_, result_.model.effects);
    for (const Modulation& m : modulated_carriers(all, first_carrier, all.size())) {
      products.push_back(m);
    }
    BlockFits fits = tallied(all, products);
    std::vector<Term> terms = terms_of_model(fits, effects);
    return {std::move(fits), std::move(terms), effects, first_carrier};
  }

  /// Whether the names of what was found stand: more than any law that no robot has, constant, and
  /// no worse than laws without a name.
  void question_names() {
    const Questions asked = questions();
    const std::size_t effects = asked.effects;
    const Eigen::VectorXd errors = asked.fits.held_out(asked.terms);
    const double error = errors.sum();
    const double placebo = best_placebo(asked.fits, asked.terms, effects, asked.first_carrier);
    result_.placebo = placebo / error;
    Eigen::VectorXd own_gain(static_cast<Eigen::Index>(effects));
    for (std::size_t k = 0; k < effects; ++k) {
      const double share = result_.found[k].gain;  // of the error without it
      own_gain[static_cast<Eigen::Index>(k)] = error * share / (1.0 - share);
    }
    const auto varies = variations(asked.fits, asked.terms, own_gain);
    std::vector<std::optional<std::size_t>> own_term;
    std::size_t next = 1;  // after the masses
    for (const AppliedEffect& a : result_.model.effects) {
      const bool column = !a.effect->transform.any();
      own_term.push_back(column ? std::optional(next++) : std::nullopt);
    }
    const Contest against = contest(asked.fits, asked.terms, own_term, asked.first_carrier);
    result_.strangers = against.strangers;
    for (std::size_t k = 0; k < effects; ++k) {
      const double own = own_gain[static_cast<Eigen::Index>(k)];
      result_.found[k].varies = varies[k];
      result_.found[k].displaced = against.displaced[k];
      result_.found[k].drowned = own < placebo;
      const auto joint = joint_of(robot_, result_.model.effects[k]);
      for (std::size_t other = 0; other < effects; ++other) {
        if (!joint || joint_of(robot_, result_.model.effects[other]) != joint) continue;
        if (varies[other] && own_gain[static_cast<Eigen::Index>(other)] > own) {
          result_.found[k].beside_unknown = true;
        }
      }
      if (!own_term[k]) {
        result_.found[k].displaced = stranger_in_place_of(k, errors, own);
      }
    }
  }

  /// Whether a law without a name predicts better than an applied transformation, which has no term
  /// that could be left out: the sums are made once more without it.
  [[nodiscard]] bool stranger_in_place_of(std::size_t k, const Eigen::VectorXd& named,
                                          double own_gain) {
    const std::vector<Found> all = result_.found;
    result_.found.erase(result_.found.begin() + static_cast<std::ptrdiff_t>(k));
    collect_effects();
    const Questions without = questions();
    const auto instead =
        with_best_stranger(without.fits, without.terms, without.effects, without.first_carrier);
    result_.found = all;
    collect_effects();
    return instead && takes_the_place(named, *instead, own_gain);
  }

  /// Held-out error of the present effects, linear numbers refitted.
  [[nodiscard]] Eigen::VectorXd held_out_of_model() {
    const BlockFits fits = tallied(result_.model.effects);
    return fits.held_out(terms_of_model(fits, fits.tally().hypotheses.size()));
  }

  /// Masses and the first `effects` hypotheses of a tally: all present effects.
  [[nodiscard]] std::vector<Term> terms_of_model(const BlockFits& fits, std::size_t effects) const {
    std::vector<Term> terms = {always(fits.tally())};
    for (std::size_t k = 0; k < effects; ++k) {
      const AppliedEffect& a = fits.tally().hypotheses[k];
      if (a.effect->transform.any()) continue;
      terms.push_back(term_of(robot_, fits.tally(), k));
      if (came_since(a)) terms.back().from_block = fits.first_block();
    }
    return terms;
  }

  [[nodiscard]] bool is_banned(const AppliedEffect& h) const {
    return std::any_of(banned_.begin(), banned_.end(),
                       [&](const AppliedEffect& b) { return same_place(b, h); });
  }

  void take(const BlockFits& fits, const Term& fixed, const std::vector<Candidate>& list,
            const Selection& selection) {
    // Transformations that are applied already stay as they were judged.
    std::erase_if(result_.found, [](const Found& f) { return !f.effect.effect->transform.any(); });
    Eigen::Index column = std::ssize(fixed.columns);
    for (const Verdict& verdict : selection.accepted) {
      const Candidate& candidate = list[verdict.candidate];
      const Eigen::Index n = std::ssize(candidate.term.columns);
      Found found{candidate.effect,
                  candidate.term.id,
                  selection.fit.standard_error.segment(column, n),
                  verdict.gain,
                  verdict.t,
                  candidate.since_reference,
                  {},
                  {}};
      found.effect.value = selection.fit.value.segment(column, n);
      column += n;
      auto& names = found.ambiguous_with;
      for (const std::size_t k : verdict.ambiguous) names.push_back(list[k].term.id);
      std::sort(names.begin(), names.end());
      names.erase(std::unique(names.begin(), names.end()), names.end());
      result_.found.push_back(found);
    }
    set_masses(selection.fit);
    step_transformations(fits.tally(), fixed, selection.fit);
    collect_effects();
    const auto per_sample = [&](const Eigen::VectorXd& errors) {
      std::size_t samples = 0;
      for (std::size_t b = fits.first_block(); b < fits.tally().blocks.size(); ++b) {
        samples += fits.tally().blocks[b].samples;
      }
      return errors.sum() / static_cast<double>(samples * static_cast<std::size_t>(robot_.dof()));
    };
    result_.error_given = per_sample(selection.error_given);
    result_.error_rigid = per_sample(selection.error_rigid);
    result_.error_end = per_sample(selection.error_end);
    result_.blocks = fits.tally().blocks.size();
    result_.samples = 0;
    for (const Block& b : fits.tally().blocks) result_.samples += b.samples;
    result_.hypotheses = list.size();
    const auto ranked = [&](const std::vector<Scored>& scores) {
      std::vector<Ranked> ranking;
      for (const Scored& s : scores) {
        ranking.push_back({list[s.candidate].term.id, s.gain, s.t});
      }
      return ranking;
    };
    if (round_ == 0 && !selection.steps.empty()) {
      std::vector<Scored> first = selection.steps.front().others;
      first.insert(first.begin(), selection.steps.front().accepted);
      result_.first_ranking = ranked(first);
    }
    result_.last_ranking = ranked(selection.last_ranking);
    result_.hidden.clear();
    for (const std::size_t k : selection.hidden) {
      const std::string& id = list[k].term.id;
      if (result_.hidden.empty() || result_.hidden.back() != id) result_.hidden.push_back(id);
    }
    result_.wrong_signs.clear();
    for (const Scored& s : selection.wrong_signs) {
      result_.wrong_signs.emplace_back(
          list[s.candidate].term.id,
          (s.fit.value.array() / s.fit.standard_error.array()).minCoeff());
    }
  }

  /// Gauss-Newton: applied transformations move by what their columns were fitted with.
  void step_transformations(const Tally& tally, const Term& fixed, const Fit& fit) {
    auto column = std::ssize(masses_.columns);
    for (std::size_t k = 0; k < tally.hypotheses.size() && column < std::ssize(fixed.columns);
         ++k) {
      if (!is_applied_transformation(tally.hypotheses[k])) continue;
      for (Found& f : result_.found) {
        if (!same_place(f.effect, tally.hypotheses[k])) continue;
        const Eigen::Index n = f.effect.value.size();
        f.effect.value += fit.value.segment(column, n);
        f.standard_error = fit.standard_error.segment(column, n);
        column += n;
      }
    }
  }

  void collect_effects() {
    result_.model.effects.clear();
    for (Found& f : result_.found) {
      if (f.effect.effect->transform.any()) keep_within_limits(f.effect);
      result_.model.effects.push_back(f.effect);
    }
  }

  static void keep_within_limits(AppliedEffect& a) {
    for (Eigen::Index p = 0; p < a.value.size(); ++p) {
      const Parameter& parameter = a.effect->parameters[static_cast<std::size_t>(p)];
      const double lower = parameter.nonnegative ? 0.0 : -parameter.limit;
      a.value[p] = std::clamp(a.value[p], lower, parameter.limit);
    }
  }

  /// Shape numbers by zooming grids, transformations by Gauss-Newton, masses along with both.
  void refit() {
    constexpr int passes = 3;
    for (int pass = 0; pass < passes && needs_refit(); ++pass) {
      std::vector<AppliedEffect> variants;
      std::vector<std::vector<std::size_t>> of_found(result_.found.size());
      for (std::size_t i = 0; i < result_.found.size(); ++i) {
        for (const AppliedEffect& a : shape_variants(result_.found[i].effect, pass)) {
          of_found[i].push_back(variants.size());
          variants.push_back(a);
        }
      }
      const BlockFits fits = tallied(variants);
      std::vector<std::vector<Term>> choices;
      for (std::size_t i = 0; i < of_found.size(); ++i) {
        auto& terms = choices.emplace_back();
        for (const std::size_t v : of_found[i]) {
          terms.push_back(term_of(robot_, fits.tally(), v));
          if (result_.found[i].since_reference) terms.back().from_block = fits.first_block();
        }
      }
      const std::vector<std::size_t> chosen = best_variants(fits, masses_, choices);
      std::vector<Term> terms = {masses_};
      for (std::size_t i = 0; i < choices.size(); ++i) terms.push_back(choices[i][chosen[i]]);
      const Fit fit = fits.fit(terms);
      set_masses(fit);
      Eigen::Index column = std::ssize(masses_.columns);
      for (std::size_t i = 0; i < choices.size(); ++i) {
        AppliedEffect& a = result_.found[i].effect;
        const Eigen::Index n = a.value.size();
        const Eigen::VectorXd value = fit.value.segment(column, n);
        a.shape = variants[of_found[i][chosen[i]]].shape;
        a.value = a.effect->transform.any() ? Eigen::VectorXd(a.value + value) : value;
        result_.found[i].standard_error = fit.standard_error.segment(column, n);
        column += n;
      }
      collect_effects();
    }
  }

  [[nodiscard]] bool needs_refit() const {
    return std::any_of(result_.found.begin(), result_.found.end(), [](const Found& f) {
      return f.effect.effect->transform.any() || f.effect.shape.size() > 0;
    });
  }

  const Robot& robot_;
  Recording log_;
  const Recording* reference_;
  const LoopSettings& settings_;
  Eigen::VectorXd centre_;  ///< of the prior, 10 links
  Term masses_;
  TallyOptions tally_options_;
  std::vector<AppliedEffect> banned_;
  std::optional<Candidate> large_;
  int round_ = 0;
  LoopResult result_;
};

}  // namespace

LoopResult close_loop(const Robot& robot, const Recording& log, const Recording* reference,
                      const LoopSettings& settings) {
  return Loop(robot, log, reference, settings).run();
}

}  // namespace shapeid::diagnosis
