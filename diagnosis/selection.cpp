#include "shapeid/diagnosis/selection.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "shapeid/diagnosis/contenders.hpp"
#include "shapeid/diagnosis/credibility.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/diagnosis/in_parallel.hpp"
#include "shapeid/diagnosis/verdicts.hpp"

namespace shapeid::diagnosis {
namespace {

// A simpler hypothesis is taken if the best is not better by more than this: one standard error, as
// usual in cross-validation. Two would leave so much of a large effect that further names take it.
constexpr double simpler_t = 1.0;

class Search {
 public:
  Search(const BlockFits& fits, const Term& masses, const std::vector<Candidate>& candidates,
         const SelectionRule& rule)
      : fits_(fits),
        rule_(rule),
        contenders_(fits, masses, candidates, rule.contained_too),
        credibility_(fits, contenders_, rule) {}

  Selection run() {
    go_on();
    try_from_usual();
    finish();
    return std::move(result_);
  }

 private:
  /// From what is accepted, until nothing changes.
  void go_on() {
    do {
      while (std::ssize(accepted_) < rule_.most_terms && advance()) {
      }
    } while (prune());
    simplify();
  }

  /// One law that looks like the sum of several causes (a drag, of friction at all joints) comes in
  /// first, and then none of them is worth enough beside it. So the search begins once more where a
  /// roboticist would: with all that is usually fitted, of which stays what would be accepted
  /// beside the rest, now and in the end.
  void try_from_usual() {
    if (rule_.from_usual == FromUsual::not_asked) return;
    const Chosen usual = contenders_.usual();
    const Chosen start = worthy(pruned(usual, credibility_.limit(), rule_.threads), usual);
    if (std::ranges::all_of(start, [this](std::size_t k) { return is_accepted(k); })) return;
    const Chosen accepted = std::exchange(accepted_, start);
    const auto came_with = std::exchange(came_with_, {});
    const Chosen dropped = std::exchange(dropped_, {});
    const Selection result = result_;
    const std::optional<Chosen> ranked_beside = ranked_beside_;
    go_on();
    accepted_ = worthy(accepted_, start);
    const bool is_better = gain_of(fits_.held_out(contenders_.terms(accepted)),
                                   fits_.held_out(contenders_.terms(accepted_)))
                               .t > not_worse_t;
    if (!is_better || rule_.from_usual != FromUsual::taken) {
      accepted_ = accepted;
      came_with_ = came_with;
      dropped_ = dropped;
      result_ = result;
      ranked_beside_ = ranked_beside;
    }
    result_.usual_is_better = is_better;
  }

  [[nodiscard]] bool is_accepted(std::size_t k) const {
    return std::count(accepted_.begin(), accepted_.end(), k) > 0;
  }

  [[nodiscard]] bool would_be_accepted(std::size_t k, const Chosen& others) const {
    const std::vector<Term> without = contenders_.terms(others),
                            with = contenders_.terms(others, k);
    const Gain gain = credibility_.gain_by(k, fits_.held_out(without), fits_.held_out(with));
    return credibility_.passes({k, gain.share, gain.t, {}}) &&
           (rule_.contained_too || !contenders_.is_contained(k, others)) &&
           credibility_.credible(k, others, fits_.fit(without), fits_.fit(with));
  }

  /// Without those of `asked` that would not be accepted beside the rest.
  [[nodiscard]] Chosen worthy(Chosen chosen, const Chosen& asked) const {
    while (true) {
      const auto unworthy = std::ranges::find_if(chosen, [&](std::size_t k) {
        Chosen others = chosen;
        std::erase(others, k);
        return std::ranges::count(asked, k) > 0 && !would_be_accepted(k, others);
      });
      if (unworthy == chosen.end()) return chosen;
      chosen.erase(unworthy);
    }
  }

  /// A candidate beside what is accepted, and the held-out errors with it.
  struct Rank {
    Scored scored;
    Eigen::VectorXd errors;
  };

  /// All of the shortlist, what gains most first; noted, with what else that shows.
  [[nodiscard]] std::vector<Rank> ranked() {
    std::vector<Rank> ranking = scored();
    std::ranges::stable_sort(ranking, std::ranges::greater(),
                             [](const Rank& r) { return r.scored.gain; });
    result_.last_ranking.clear();
    for (const Rank& r : ranking) result_.last_ranking.push_back(r.scored);
    note_wrong_signs();
    ranked_beside_ = accepted_;
    return ranking;
  }

  /// Accepts the best that passes; false if there is none.
  bool advance() {
    const std::vector<Rank> ranking = ranked();
    const auto is_open = [&](const Rank& r) {
      return credibility_.passes(r.scored) && r.scored.credible && !r.scored.wrong_sign;
    };
    const auto best = std::ranges::find_if(ranking, is_open);
    if (best == ranking.end()) return false;

    // Of those that cannot be told from the best the simplest is taken: of as many numbers what
    // always acts, rather than what came since the reference log, and that rather than what went.
    const auto extent = [&](const Rank& r) {
      const std::size_t k = r.scored.candidate;
      return std::pair(contenders_.cost(k), contenders_[k].effect.when);
    };
    const Rank* chosen = &*best;
    for (const Rank& r : ranking) {
      if (!is_open(r) || gain_of(r.errors, best->errors).t > simpler_t) continue;
      if (extent(r) < extent(*chosen)) chosen = &r;
    }
    SelectionStep step;
    step.accepted = chosen->scored;
    for (const Rank& r : ranking) {
      if (&r != chosen) step.others.push_back(r.scored);
    }
    accept(chosen->scored.candidate);
    result_.steps.push_back(std::move(step));
    return true;
  }

  /// The shortlist beside what is accepted.
  [[nodiscard]] std::vector<Rank> scored() {
    const FitsAround now(fits_, contenders_.terms(accepted_));
    const Fit fit_now = fits_.fit(contenders_.terms(accepted_));
    Shortlist shortlist = contenders_.shortlist(accepted_, rule_.shortlist, dropped_);
    result_.hidden = std::move(shortlist.hidden);
    std::vector<Rank> ranking(shortlist.listed.size());
    in_parallel(ranking.size(), rule_.threads, [&](std::size_t i) {
      const std::size_t k = shortlist.listed[i];
      Eigen::VectorXd errors = now.with(contenders_[k].term);
      const Gain gain = credibility_.gain_by(k, now.error(), errors);
      Scored scored{k, gain.share, gain.t, {}, false};
      if (credibility_.passes(scored)) {
        const Fit fit = fits_.fit(contenders_.terms(accepted_, k));
        scored.fit = contenders_.last_of(k, fit);
        scored.credible = credibility_.credible(k, accepted_, fit_now, fit);
        // Of a group the members with a wrong sign are dropped at the end; a credible load is a
        // body, whatever sign its free numbers have.
        const bool is_load = contenders_[k].effect.effect->is_payload;
        scored.wrong_sign = contenders_[k].members.empty() && !(is_load && scored.credible) &&
                            credibility_.wrong_sign(k, scored.fit, 0.0);
      }
      ranking[i] = {std::move(scored), std::move(errors)};
    });
    return ranking;
  }

  void note_wrong_signs() {
    result_.wrong_signs.clear();
    for (const Scored& s : result_.last_ranking) {
      if (s.wrong_sign && credibility_.wrong_sign(s.candidate, s.fit, rule_.least_t)) {
        result_.wrong_signs.push_back(s);
      }
    }
  }

  void accept(std::size_t k) {
    const auto& members = contenders_[k].members;
    if (members.empty()) accepted_.push_back(k);
    for (const std::size_t m : members) {
      came_with_[m] = static_cast<double>(contenders_[k].term.columns.size());
    }
    accepted_.insert(accepted_.end(), members.begin(), members.end());
  }

  /// Without what others in it make superfluous, or give an impossible sign or a size that is not
  /// believed (a delay and the lags of all drives may cancel), and without ripples that came with
  /// those of other joints and are nothing by themselves; these first, and of them the one that
  /// gains least.
  [[nodiscard]] Chosen pruned(Chosen chosen, double least_t, std::size_t threads) const {
    while (!chosen.empty()) {
      const Fit all = fits_.fit(contenders_.terms(chosen));
      const FitsAround now(fits_, contenders_.terms(chosen));
      std::vector<Eigen::Index> column = {contenders_.first_column()};
      for (const std::size_t k : chosen) {
        column.push_back(column.back() + std::ssize(contenders_[k].term.columns));
      }
      using Worth = std::pair<bool, double>;  // believed, and standard errors of gain
      std::vector<Worth> worth(chosen.size());
      in_parallel(chosen.size(), threads, [&](std::size_t i) {
        const Fit own = part_of(all, column[i], column[i + 1] - column[i]);
        const Gain gain = credibility_.gain_by(chosen[i], now.without(1 + i), now.error());
        worth[i] = {gain.share >= 0.0 && is_believed(chosen, i, all, own), gain.t};
      });
      Worth least = {true, least_t};
      std::size_t worst = chosen.size();
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (!(worth[i] < least)) continue;
        least = worth[i];
        worst = i;
      }
      if (worst == chosen.size()) break;
      chosen.erase(chosen.begin() + static_cast<std::ptrdiff_t>(worst));
    }
    return chosen;
  }

  [[nodiscard]] bool is_believed(const Chosen& chosen, std::size_t i, const Fit& all,
                                 const Fit& own) const {
    const std::size_t k = chosen[i];
    Chosen others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const bool is_load = contenders_[k].effect.effect->is_payload;
    if (!is_load && credibility_.wrong_sign(k, own, 0.0)) return false;
    if (!credibility_.within_limits(k, others, own)) return false;
    return !(contenders_[k].choices > 1.0) || credibility_.ripples(k, others, all, own);
  }

  /// Drops what later terms made superfluous. It does not come back, but may still be named as a
  /// rival. True if anything was.
  bool prune() {
    const Chosen before = accepted_;
    accepted_ = pruned(before, keep_t, rule_.threads);
    for (const std::size_t k : before) {
      if (!is_accepted(k)) dropped_.push_back(k);
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
      const Eigen::VectorXd error = fits_.held_out(contenders_.terms(accepted_));
      Chosen best = accepted_;
      const Chosen rivals = contenders_.shortlist({}, rule_.rivals).listed;
      std::vector<Chosen> with_each(rivals.size());
      in_parallel(rivals.size(), rule_.threads,
                  [&](std::size_t i) { with_each[i] = beside(rivals[i]); });
      for (const Chosen& with_rival : with_each) {
        if (with_rival.empty()) continue;
        if (contenders_.extent(with_rival) >= contenders_.extent(best)) continue;
        const bool fewer_numbers = contenders_.cost(with_rival) < contenders_.cost(accepted_);
        const double allowed = with_rival.size() == accepted_.size() ? simpler_t
                               : fewer_numbers                       ? not_worse_t
                                                                     : 0.0;
        if (gain_of(fits_.held_out(contenders_.terms(with_rival)), error).t > allowed) continue;
        best = with_rival;
      }
      simpler = best != accepted_;
      accepted_ = best;
    }
  }

  /// A rival and those of the accepted that it does not make superfluous, which it is not itself;
  /// else none.
  [[nodiscard]] Chosen beside(std::size_t rival) const {
    if (contenders_.is_taken(rival, accepted_) || !contenders_[rival].members.empty()) return {};
    Chosen with_rival = accepted_;
    with_rival.push_back(rival);
    with_rival = pruned(with_rival, keep_t, 1);
    return !with_rival.empty() && with_rival.back() == rival ? with_rival : Chosen{};
  }

  void finish() {
    // What was accepted may have been changed since it was ranked last.
    if (ranked_beside_ != accepted_) static_cast<void>(ranked());
    result_.error_end = fits_.held_out(contenders_.terms(accepted_));
    result_.fit = fits_.fit(contenders_.terms(accepted_));
    result_.accepted =
        Verdicts(fits_, contenders_, credibility_, rule_).of(accepted_, result_.error_end);
    for (Verdict& verdict : result_.accepted) {
      const auto group = came_with_.find(verdict.candidate);
      if (group == came_with_.end()) continue;
      Chosen others = accepted_;
      std::erase(others, verdict.candidate);
      verdict.by_itself = credibility_.is_by_itself(verdict.candidate, others, group->second);
    }
  }

  const BlockFits& fits_;
  const SelectionRule& rule_;
  Contenders contenders_;
  Credibility credibility_;
  Chosen accepted_, dropped_;
  std::optional<Chosen> ranked_beside_;
  std::map<std::size_t, double> came_with_;  ///< of members of a group: how many numbers it has
  Selection result_;
};

}  // namespace

Selection select(const BlockFits& fits, const Term& masses,
                 const std::vector<Candidate>& candidates, const SelectionRule& rule) {
  return Search(fits, masses, candidates, rule).run();
}

}  // namespace shapeid::diagnosis
