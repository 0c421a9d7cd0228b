#include "shapeid/diagnosis/selection.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

// A simpler set of causes is taken if it is not worse than this many standard errors.
constexpr double separable = 2.0;
// What comes within this many is named beside an accepted one: of a hundred causes that are there
// about one is further behind by chance, with so few blocks.
constexpr double told_apart_t = 2.5;
// A simpler hypothesis is taken if the best is not better by more than this: one standard error, as
// usual in cross-validation. Two would leave so much of a large effect that further names take it.
constexpr double simpler_t = 1.0;
// What cannot be negative must not be so by more than this many standard errors in a rival. In what
// is accepted it must not be at all; but of a rival's ten numbers one may, within its error.
constexpr double rival_sign_t = 2.0;
// Standard errors by which a rival must gain to be named in an accepted one's place.
constexpr double rival_t = 1.0;
// By how much both measures together must exceed what chance makes of nothing. (Of 159 clean logs
// of blind trials none had more than 0.95, a length and a lag that had been named in others 0.96
// and less. Of 162 single effects of two and four times the detectable size two had less than 1.1.)
constexpr double least_of_both = 1.1;
// Onsets of one load that are looked at more closely.
constexpr std::ptrdiff_t most_of_one_place = 2;
// One hypothesis contains another if this share of its columns is in the other's span.
constexpr double nested_share = 0.9999;

class Search {
 public:
  Search(const BlockFits& fits, const Term& masses, const std::vector<Candidate>& candidates,
         const SelectionRule& rule)
      : fits_(fits), masses_(masses), candidates_(candidates), rule_(rule) {}

  Selection run() {
    limit_ = limit_for(rule_.least_t, fits_.held_blocks());
    for (const Candidate& c : candidates_) {
      if (c.members.empty()) parameters_ += static_cast<double>(c.term.columns.size());
    }
    do {
      while (std::ssize(accepted_) < rule_.most_terms && advance()) {
      }
    } while (prune());
    simplify();
    finish();
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<Term> terms(const std::vector<std::size_t>& chosen) const {
    std::vector<Term> list = {masses_};
    for (const std::size_t k : chosen) list.push_back(candidates_[k].term);
    return list;
  }

  [[nodiscard]] std::vector<Term> with(std::size_t k) const {
    std::vector<Term> list = terms(accepted_);
    list.push_back(candidates_[k].term);
    return list;
  }

  /// It, another onset of it, or a member of the group is in already.
  [[nodiscard]] bool taken(std::size_t k) const {
    return any_single(k, [&](std::size_t single) {
      return std::any_of(accepted_.begin(), accepted_.end(),
                         [&](std::size_t other) { return same_place(single, other); });
    });
  }

  /// It, or a member of the group, was in and did not stay. It may still be named as a rival.
  [[nodiscard]] bool dropped(std::size_t k) const {
    return any_single(k, [&](std::size_t single) {
      return std::count(dropped_.begin(), dropped_.end(), single) > 0;
    });
  }

  [[nodiscard]] bool any_single(std::size_t k,
                                const std::function<bool(std::size_t)>& condition) const {
    const auto& members = candidates_[k].members;
    return members.empty() ? condition(k) : std::any_of(members.begin(), members.end(), condition);
  }

  [[nodiscard]] bool same_place(std::size_t k, std::size_t other) const {
    const Candidate &a = candidates_[k], &b = candidates_[other];
    return a.effect.effect == b.effect.effect && a.effect.site == b.effect.site &&
           a.since_reference == b.since_reference;
  }

  /// The most promising beside what is accepted.
  [[nodiscard]] std::vector<std::size_t> shortlist(int length, bool with_dropped) {
    std::vector<std::size_t> open;
    std::vector<Term> open_terms;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      if (taken(k) || (!with_dropped && dropped(k))) continue;
      open.push_back(k);
      open_terms.push_back(candidates_[k].term);
    }
    const auto promises = fits_.promises(terms(accepted_), open_terms);
    std::vector<std::size_t> order(open.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return promises[a].gain > promises[b].gain;
    });
    result_.hidden.clear();
    std::vector<std::size_t> list;
    for (const std::size_t i : order) {
      // A load's moments must not crowd out what is something else.
      const auto listed = std::count_if(
          list.begin(), list.end(), [&](std::size_t other) { return same_place(open[i], other); });
      if (promises[i].hidden()) {
        result_.hidden.push_back(open[i]);
      } else if (std::ssize(list) < length && listed < most_of_one_place) {
        list.push_back(open[i]);
      }
    }
    return list;
  }

  /// True if a parameter that cannot be negative is, and significantly.
  [[nodiscard]] bool wrong_sign(std::size_t k, const Fit& fit, double least_t) const {
    const auto& nonnegative = candidates_[k].term.nonnegative;
    for (std::size_t i = 0; i < nonnegative.size(); ++i) {
      const auto p = static_cast<Eigen::Index>(i);
      if (nonnegative[i] && fit.value[p] < -least_t * fit.standard_error[p]) return true;
    }
    return false;
  }

  /// Candidate k, in `with` and not in `without`, is more than chance makes of nothing, and leaves
  /// the range in which it is believed with no number. Of a group that is asked of all its members'
  /// numbers together; they are judged one by one at the end.
  [[nodiscard]] bool credible(std::size_t k, const Fit& without, const Fit& with) const {
    const double tried = parameters_ * candidates_[k].choices;
    if (!candidates_[k].members.empty()) {
      return std::sqrt(squares_over_chance(k, without, with, tried)) > least_of_both;
    }
    const Fit own = last_of(k, with);
    return over_chance(k, without, with, own, tried) > least_of_both && within_limits(k, own);
  }

  /// Of so many numbers that are tried.
  [[nodiscard]] double squares_over_chance(std::size_t k, const Fit& without, const Fit& with,
                                           double tried) const {
    return std::max(0.0, squares_sum(without, with)) /
           least_squares_sum(rule_.false_alarms / tried, std::ssize(candidates_[k].term.columns));
  }

  [[nodiscard]] double over_chance(std::size_t k, const Fit& without, const Fit& with,
                                   const Fit& own, double tried) const {
    const double limit = limit_for(least_z(rule_.false_alarms, tried), fits_.held_blocks());
    return both(differs(k, own) / limit, squares_over_chance(k, without, with, tried));
  }

  /// Standard errors by which some parameter differs from zero. A load has mass. A sine and a
  /// cosine of a period that was sought have one error, which is known badly from so few blocks: of
  /// two estimates, among many periods, the smaller one would be small by chance.
  [[nodiscard]] double differs(std::size_t k, const Fit& fit) const {
    if (candidates_[k].choices > 1.0) return fit.value.norm() / fit.between_blocks.maxCoeff();
    const Eigen::ArrayXd each = fit.value.array() / fit.between_blocks.array();
    return candidates_[k].effect.effect->is_payload ? each[0] : each.abs().maxCoeff();
  }

  /// None of its values leaves the range in which it is believed.
  [[nodiscard]] bool within_limits(std::size_t k, const Fit& fit) const {
    const Effect& effect = *candidates_[k].effect.effect;
    for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      // The column of a transformation is that of a change.
      const double start = effect.transform.any() ? candidates_[k].effect.value[at] : 0.0;
      const Parameter& parameter = effect.parameters[p];
      const double limit = parameter.unit == "N" ? rule_.most_force : parameter.limit;
      if (std::abs(start + fit.value[at]) > limit) return false;
    }
    return true;
  }

  /// Of all that was accepted and candidate k the part of k.
  [[nodiscard]] Fit fit_of(std::size_t k) const { return last_of(k, fits_.fit(with(k))); }

  [[nodiscard]] Fit last_of(std::size_t k, const Fit& fit) const {
    const Eigen::Index n = std::ssize(candidates_[k].term.columns);
    return part_of(fit, fit.value.size() - n, n);
  }

  [[nodiscard]] static Fit part_of(const Fit& fit, Eigen::Index from, Eigen::Index n) {
    return {fit.value.segment(from, n), fit.standard_error.segment(from, n),
            fit.between_blocks.segment(from, n), fit.left, fit.freedom};
  }

  /// By candidate k. What acts from a moment on gains in the blocks after it. Those before add to
  /// the gain where masses had taken some of it, and only to the scatter where none are free: the
  /// larger t of both counts. Fewer blocks mean a wider limit; t is in proportion to that of all.
  [[nodiscard]] Gain gain_by(std::size_t k, const Eigen::VectorXd& before,
                             const Eigen::VectorXd& after) const {
    Gain gain = gain_of(before, after);
    const std::size_t from = candidates_[k].term.from_block;
    if (from <= fits_.first_block()) return gain;
    const Eigen::Index acts = before.size() - static_cast<Eigen::Index>(from - fits_.first_block());
    const double t = gain_of(before.tail(acts), after.tail(acts)).t;
    gain.t = std::max(gain.t, t * limit_ / limit_for(rule_.least_t, acts));
    return gain;
  }

  bool advance() {
    const FitsAround now(fits_, terms(accepted_));
    const Fit fit_now = fits_.fit(terms(accepted_));
    std::vector<Scored> ranking;
    std::vector<Eigen::VectorXd> errors;
    for (const std::size_t k : shortlist(rule_.shortlist, false)) {
      const Eigen::VectorXd after = now.with(candidates_[k].term);
      const Gain gain = gain_by(k, now.error(), after);
      Scored scored{k, gain.share, gain.t, {}, false};
      if (passes(scored)) {
        const Fit fit = fits_.fit(with(k));
        scored.fit = last_of(k, fit);
        if (!credible(k, fit_now, fit)) scored.gain = scored.t = 0.0;
        // Of a group the members with a wrong sign are dropped at the end.
        scored.wrong_sign = candidates_[k].members.empty() && wrong_sign(k, scored.fit, 0.0);
      }
      ranking.push_back(scored);
      errors.push_back(after);
    }
    note_wrong_signs(ranking);
    std::vector<std::size_t> order(ranking.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return ranking[a].gain > ranking[b].gain;
    });
    result_.last_ranking.clear();
    for (const std::size_t i : order) result_.last_ranking.push_back(ranking[i]);

    const auto best = std::find_if(order.begin(), order.end(), [&](std::size_t i) {
      return passes(ranking[i]) && !ranking[i].wrong_sign;
    });
    if (best == order.end()) return false;

    // Of those that cannot be told from the best the simplest is taken.
    std::size_t chosen = *best;
    for (const std::size_t i : order) {
      if (!passes(ranking[i]) || ranking[i].wrong_sign) continue;
      if (gain_of(errors[i], errors[*best]).t > simpler_t) continue;
      if (cost(ranking[i].candidate) < cost(ranking[chosen].candidate)) chosen = i;
    }
    SelectionStep step;
    step.accepted = ranking[chosen];
    for (const std::size_t i : order) {
      if (i != chosen) step.others.push_back(ranking[i]);
    }
    accept(ranking[chosen].candidate);
    result_.steps.push_back(std::move(step));
    return true;
  }

  void accept(std::size_t k) {
    const auto& members = candidates_[k].members;
    if (members.empty()) accepted_.push_back(k);
    for (const std::size_t m : members) {
      came_with_[m] = static_cast<double>(candidates_[k].term.columns.size());
    }
    accepted_.insert(accepted_.end(), members.begin(), members.end());
  }

  [[nodiscard]] bool passes(const Scored& s) const { return s.t > limit_ && s.gain > 0.0; }

  /// Parameters, those of shape and transformations counted on top.
  [[nodiscard]] std::size_t cost(std::size_t k) const {
    const Effect& e = *candidates_[k].effect.effect;
    return candidates_[k].term.columns.size() + e.shape.size() + (e.transform.any() ? 1 : 0);
  }

  [[nodiscard]] std::size_t numbers(const std::vector<std::size_t>& chosen) const {
    std::size_t sum = 0;
    for (const std::size_t k : chosen) sum += cost(k);
    return sum;
  }

  /// Findings, and numbers in them: what is smaller is simpler.
  [[nodiscard]] std::pair<std::size_t, std::size_t> extent(
      const std::vector<std::size_t>& chosen) const {
    return {chosen.size(), numbers(chosen)};
  }

  void note_wrong_signs(const std::vector<Scored>& ranking) {
    result_.wrong_signs.clear();
    for (const Scored& s : ranking) {
      if (s.wrong_sign && wrong_sign(s.candidate, s.fit, rule_.least_t)) {
        result_.wrong_signs.push_back(s);
      }
    }
  }

  /// Without what others in it make superfluous, or give an impossible sign or a size that is not
  /// believed (a delay and the lags of all drives may cancel), and without ripples that came with
  /// those of other joints and are nothing by themselves; these first, and of them the one that
  /// gains least.
  [[nodiscard]] std::vector<std::size_t> pruned(std::vector<std::size_t> chosen) const {
    while (!chosen.empty()) {
      const Fit all = fits_.fit(terms(chosen));
      const FitsAround now(fits_, terms(chosen));
      std::pair<bool, double> least = {true, keep_t};  // believed, and standard errors of gain
      std::size_t worst = chosen.size();
      Eigen::Index column = std::ssize(masses_.columns);
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const Eigen::Index n = std::ssize(candidates_[chosen[i]].term.columns);
        const Fit own = part_of(all, column, n);
        column += n;
        const Gain gain = gain_by(chosen[i], now.without(1 + i), now.error());
        const std::pair<bool, double> own_worth = {
            !wrong_sign(chosen[i], own, 0.0) && gain.share >= 0.0 &&
                within_limits(chosen[i], own) &&
                (!(candidates_[chosen[i]].choices > 1.0) || ripples(chosen, i, all, own)),
            gain.t};
        if (own_worth < least) {
          least = own_worth;
          worst = i;
        }
      }
      if (worst == chosen.size()) break;
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(worst));
    }
    return chosen;
  }

  /// Whether a ripple is one by itself, of those in `chosen`.
  [[nodiscard]] bool ripples(std::vector<std::size_t> chosen, std::size_t i, const Fit& all,
                             const Fit& own) const {
    const std::size_t k = chosen[i];
    chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(i));
    const double tried = parameters_ * candidates_[k].choices;
    return over_chance(k, fits_.fit(terms(chosen)), all, own, tried) > least_of_both;
  }

  /// Whether candidate k, beside those that are accepted now, is something by itself if it came
  /// with the same at other joints: more than chance makes of one of so many.
  [[nodiscard]] bool is_by_itself(std::size_t k) const {
    const auto group = came_with_.find(k);
    if (group == came_with_.end()) return true;
    const Fit all = fits_.fit(with(k));
    return over_chance(k, fits_.fit(terms(accepted_)), all, last_of(k, all), group->second) >
           least_of_both;
  }

  /// Drops what later terms made superfluous. It does not come back. True if anything was.
  bool prune() {
    const std::vector<std::size_t> before = accepted_;
    accepted_ = pruned(before);
    for (const std::size_t k : before) {
      if (std::count(accepted_.begin(), accepted_.end(), k) == 0) dropped_.push_back(k);
    }
    return accepted_.size() < before.size();
  }

  /// One cause rather than several: what was accepted first may have been a part of a hypothesis
  /// that looked no better then, and the others its remainder (drag and lags of single drives, of
  /// one delay of all). What makes two or more of the accepted superfluous takes their place,
  /// unless the error grows by more than chance; with as many numbers as before it must not grow.
  /// One with fewer numbers takes the place of one (an offset that of a spring, which came in with
  /// those of other joints), as when it is chosen.
  void simplify() {
    bool simpler = true;
    while (simpler && !accepted_.empty()) {
      const std::vector<std::size_t> before = accepted_;
      const Eigen::VectorXd error = fits_.held_out(terms(before));
      const std::vector<std::size_t> hidden = result_.hidden;
      accepted_.clear();
      const std::vector<std::size_t> rivals = shortlist(rule_.rivals, true);
      result_.hidden = hidden;
      accepted_ = before;
      std::vector<std::size_t> best = before;
      for (const std::size_t r : rivals) {
        if (taken(r) || !candidates_[r].members.empty()) continue;
        std::vector<std::size_t> with_rival = before;
        with_rival.push_back(r);
        with_rival = pruned(with_rival);
        if (with_rival.empty() || with_rival.back() != r) continue;
        if (extent(with_rival) >= extent(best)) continue;
        const bool fewer_numbers = numbers(with_rival) < numbers(before);
        const double allowed = with_rival.size() == before.size() ? simpler_t
                               : fewer_numbers                    ? separable
                                                                  : 0.0;
        if (gain_of(fits_.held_out(terms(with_rival)), error).t > allowed) continue;
        best = with_rival;
      }
      simpler = best != before;
      accepted_ = best;
    }
  }

  void finish() {
    result_.error_end = fits_.held_out(terms(accepted_));
    result_.fit = fits_.fit(terms(accepted_));
    const std::vector<std::size_t> all = accepted_;
    for (const std::size_t k : all) {
      accepted_ = all;
      std::erase(accepted_, k);
      result_.accepted.push_back(verdict(k));
    }
    accepted_ = all;
    name_common_causes();
  }

  /// What could take the place of several at once, and was not simpler, is named with each of them:
  /// a load has more numbers than the two gains that it looks like.
  void name_common_causes() {
    if (accepted_.size() < 2) return;
    const std::vector<std::size_t> all = accepted_, hidden = result_.hidden;
    accepted_.clear();
    const std::vector<std::size_t> rivals = shortlist(rule_.rivals, true);
    accepted_ = all;
    result_.hidden = hidden;
    for (const std::size_t r : rivals) {
      if (taken(r) || !candidates_[r].members.empty()) continue;
      accepted_ = not_superfluous_beside(r, all);
      const FitsAround others(fits_, terms(accepted_));
      const Eigen::VectorXd instead = others.with(candidates_[r].term);
      const Gain own = gain_of(others.error(), instead);
      const bool takes_their_place =
          accepted_.size() + 1 < all.size() && own.t > rival_t && own.share > 0.0 &&
          !(gain_of(instead, result_.error_end).t > told_apart_t) &&
          !wrong_sign(r, fit_of(r), rival_sign_t) && within_limits(r, fit_of(r));
      for (std::size_t i = 0; takes_their_place && i < all.size(); ++i) {
        std::vector<std::size_t>& named = result_.accepted[i].ambiguous;
        if (std::count(accepted_.begin(), accepted_.end(), all[i]) == 0 &&
            std::count(named.begin(), named.end(), r) == 0) {
          named.push_back(r);
        }
      }
      accepted_ = all;
    }
  }

  /// Those of `chosen` that gain something beside them all and r.
  [[nodiscard]] std::vector<std::size_t> not_superfluous_beside(
      std::size_t r, std::vector<std::size_t> chosen) const {
    while (!chosen.empty()) {
      std::vector<Term> list = terms(chosen);
      list.push_back(candidates_[r].term);
      const FitsAround now(fits_, std::move(list));
      double least = keep_t;
      std::size_t worst = chosen.size();
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const double t = gain_of(now.without(1 + i), now.error()).t;
        if (t < least) {
          least = t;
          worst = i;
        }
      }
      if (worst == chosen.size()) break;
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(worst));
    }
    return chosen;
  }

  /// Of candidate k, beside those that are accepted now.
  [[nodiscard]] Verdict verdict(std::size_t k) {
    const FitsAround others(fits_, terms(accepted_));
    const Eigen::VectorXd& without = others.error();
    const Gain gain = gain_by(k, without, result_.error_end);
    Verdict verdict{k, gain.share, gain.t, is_by_itself(k), {}};
    const std::vector<std::size_t> hidden = result_.hidden;
    for (const std::size_t other : shortlist(rule_.rivals, true)) {
      if (other == k || same_place(k, other) || !candidates_[other].members.empty()) continue;
      const Eigen::VectorXd instead = others.with(candidates_[other].term);
      const Gain own = gain_of(without, instead);
      // Near the limit chance decides which of two passes: a rival need only gain something.
      if (!(own.t > rival_t && own.share > 0.0)) continue;
      if (gain_of(instead, result_.error_end).t > told_apart_t) continue;
      if (wrong_sign(other, fit_of(other), rival_sign_t)) continue;
      // Two that say the same contain each other: that is no reason to keep silent about one.
      const auto within = [&](std::size_t inner, std::size_t outer) {
        return fits_.contained(terms(accepted_), candidates_[inner].term, candidates_[outer].term) >
               nested_share;
      };
      const bool nested = within(k, other) && !within(other, k);
      if (!nested || does_without(k, other)) verdict.ambiguous.push_back(other);
    }
    result_.hidden = hidden;
    return verdict;
  }

  /// Whether a rival that contains k does as well without the part that contains it: a spring
  /// contains an offset, its torque at rest, but far from rest its stiffness alone may be what
  /// looks like one. It then is a cause of its own, not k with a number on top.
  [[nodiscard]] bool does_without(std::size_t k, std::size_t rival) const {
    const Candidate& whole = candidates_[rival];
    if (whole.effect.effect->is_payload || whole.term.columns.size() < 2) return false;
    const Eigen::VectorXd without = fits_.held_out(terms(accepted_));
    for (std::size_t i = 0; i < whole.term.columns.size(); ++i) {
      Term part = whole.term;
      part.columns.erase(part.columns.begin() + static_cast<std::ptrdiff_t>(i));
      part.nonnegative.erase(part.nonnegative.begin() + static_cast<std::ptrdiff_t>(i));
      if (fits_.contained(terms(accepted_), candidates_[k].term, part) > nested_share) continue;
      std::vector<Term> list = terms(accepted_);
      list.push_back(part);
      const Eigen::VectorXd instead = fits_.held_out(list);
      const Gain own = gain_of(without, instead);
      if (!(own.t > rival_t && own.share > 0.0)) continue;
      if (gain_of(instead, result_.error_end).t <= told_apart_t) return true;
    }
    return false;
  }

  const BlockFits& fits_;
  const Term& masses_;
  const std::vector<Candidate>& candidates_;
  const SelectionRule& rule_;
  double limit_ = 0.0;
  double parameters_ = 0.0;  ///< of all candidates
  std::vector<std::size_t> accepted_, dropped_;
  std::map<std::size_t, double> came_with_;  ///< of members of a group: how many numbers it has
  Selection result_;
};

}  // namespace

Selection select(const BlockFits& fits, const Term& masses,
                 const std::vector<Candidate>& candidates, const SelectionRule& rule) {
  return Search(fits, masses, candidates, rule).run();
}

}  // namespace shapeid::diagnosis
