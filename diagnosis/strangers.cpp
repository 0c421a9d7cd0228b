#include "shapeid/diagnosis/strangers.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/diagnosis/gears.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

// Logs without any in which chance makes one of all that are tried.
constexpr double false_alarms = 0.003;
constexpr std::size_t shortlist_length = 12;
// Standard errors of held-out gain, as of a name.
// A gear's column is a second derivative with many signs, which chance fits more often: of 60 clean
// logs with white noise two had one, of 2.5 and 3.0.
constexpr double least_t = 2.5, least_t_of_gear = 3.0;
// By how much both measures together must exceed their limits, because products of signals resemble
// the filter's errors. (Of 400 clean logs of blind trials two had more than 1.1 and none more than
// 1.18; of 121 foreign effects of at least twice the detectable size two had less, no curve
// either.)
constexpr double least_of_both = 1.2;
// Neighbouring blocks are correlated, and errors from so few are uncertain: they count as half as
// many. (Among 36 clean logs one in six had a law of more than 4.5 standard errors between blocks.)
constexpr Eigen::Index blocks_for_one = 2;
// Standard errors by which a stranger must predict better to take a name's place.
constexpr double better_t = 2.0;
// What fewer strangers than names leave must not be worse by more than this many.
constexpr double not_worse_t = 2.0;

class Ring {
 public:
  explicit Ring(const Questions& asked)
      : fits_(asked.fits),
        terms_(asked.terms),
        own_term_(asked.own_term),
        is_out_(asked.effects(), false),
        rivals_(asked.effects()) {
    const Tally& tally = fits_.tally();
    double parameters = 0.0;
    for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
      const Modulation& m = tally.modulations[k];
      const AppliedEffect& carrier = tally.hypotheses[m.hypothesis];
      const bool is_law = m.hypothesis < asked.effects() || m.hypothesis >= asked.first_carrier;
      if (!is_law || carrier.effect->site != SiteKind::joint) continue;
      laws_.push_back(k);
      Term& term = law_terms_.emplace_back();
      const Eigen::Index count = m.columns_of(carrier.value.size());
      for (Eigen::Index p = 0; p < count; ++p) {
        term.columns.push_back(tally.first_modulated[k] + p);
        term.nonnegative.push_back(m.of_gear());
      }
      parameters += static_cast<double>(count);
    }
    for (const std::size_t k : laws_) {
      const double tried = parameters * asked.choices[tally.modulations[k].hypothesis];
      least_z_.push_back(
          limit_for(least_z(false_alarms, tried), fits_.held_blocks() / blocks_for_one));
      least_squares_.push_back(least_squares_sum(
          false_alarms / tried, std::ssize(law_terms_[least_squares_.size()].columns)));
    }
  }

  Contest run() {
    seek_fewer(fits_.held_out(present()), 0);
    return rest();
  }

  std::optional<Contest> run_if_fewer(const Eigen::VectorXd& named, std::size_t taken_out) {
    seek_fewer(named, taken_out);
    if (in_.empty()) return std::nullopt;
    return rest();
  }

  [[nodiscard]] std::optional<BestStranger> best_beside_all() const {
    const std::optional<Best> found = best(present());
    if (!found) return std::nullopt;
    return BestStranger{as_stranger(found->law, present(), fits_.held_out(present()), found->error),
                        found->error};
  }

 private:
  static constexpr std::size_t no_effect = static_cast<std::size_t>(-1);

  Contest rest() {
    exchange();
    add();
    judge_again();
    Contest result;
    result.displaced = is_out_;
    result.rivals = rivals_;
    const Eigen::VectorXd with_all = fits_.held_out(present());
    for (const std::size_t s : in_) {
      const std::vector<Term> others = present(no_effect, s);
      result.strangers.push_back(as_stranger(s, others, fits_.held_out(others), with_all));
    }
    std::stable_sort(result.strangers.begin(), result.strangers.end(),
                     [](const Stranger& a, const Stranger& b) { return a.gain > b.gain; });
    return result;
  }

  /// Beside other terms, of which it takes the held-out error from `before` to `after`.
  [[nodiscard]] Stranger as_stranger(std::size_t s, std::vector<Term> beside,
                                     const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after) const {
    const Modulation& law = fits_.tally().modulations[laws_[s]];
    const Gain gain = gain_of(before, after);
    beside.push_back(law_terms_[s]);
    const Eigen::VectorXd value = fits_.fit(beside).value;
    const double number = value[value.size() - std::ssize(law_terms_[s].columns)];
    return {law, fits_.tally().hypotheses[law.hypothesis], gain.share, gain.t, number};
  }

  /// Masses, names that are left and strangers that are in, but without one of each.
  [[nodiscard]] std::vector<Term> present(std::size_t without_effect = no_effect,
                                          std::size_t without_law = no_effect) const {
    std::vector<bool> keep(terms_.size(), true);
    for (std::size_t k = 0; k < own_term_.size(); ++k) {
      if (own_term_[k] && (is_out_[k] || k == without_effect)) keep[*own_term_[k]] = false;
    }
    std::vector<Term> list;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (keep[i]) list.push_back(terms_[i]);
    }
    for (const std::size_t s : in_) {
      if (s != without_law) list.push_back(law_terms_[s]);
    }
    return list;
  }

  /// Of a name that is left, among the terms of present().
  [[nodiscard]] std::size_t place_of(std::size_t effect) const {
    std::size_t place = *own_term_[effect];
    for (std::size_t k = 0; k < own_term_.size(); ++k) {
      if (own_term_[k] && is_out_[k] && *own_term_[k] < *own_term_[effect]) --place;
    }
    return place;
  }

  [[nodiscard]] int joint_of_law(std::size_t s) const {
    return fits_.tally().modulations[laws_[s]].joint;
  }

  /// Strangers at joints that have none yet, the most promising first.
  [[nodiscard]] std::vector<std::size_t> shortlist(const std::vector<Term>& beside) const {
    const auto promises = fits_.promises(beside, law_terms_);
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < laws_.size(); ++s) {
      const bool taken = std::any_of(in_.begin(), in_.end(), [&](std::size_t other) {
        return joint_of_law(other) == joint_of_law(s);
      });
      if (!taken && promises[s].free_share > least_free_share) order.push_back(s);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return promises[a].gain > promises[b].gain;
    });
    order.resize(std::min(order.size(), shortlist_length));
    return order;
  }

  /// Its held-out error beside others, if it is significant.
  [[nodiscard]] std::optional<Eigen::VectorXd> significant(std::size_t s,
                                                           const FitsAround& beside) const {
    Eigen::VectorXd error = beside.with(law_terms_[s]);
    const Gain gain = gain_of(beside.error(), error);
    const bool of_gear = fits_.tally().modulations[laws_[s]].of_gear();
    if (!(gain.t > (of_gear ? least_t_of_gear : least_t) && gain.share > 0.0)) return std::nullopt;
    std::vector<Term> with = beside.terms();
    with.push_back(law_terms_[s]);
    const Fit fit = fits_.fit(with);
    const Eigen::Index n = std::ssize(law_terms_[s].columns);
    if (law_terms_[s].nonnegative[0] && fit.value.tail(n)[0] < 0.0) return std::nullopt;
    const double z =
        (fit.value.tail(n).array() / fit.between_blocks.tail(n).array()).abs().maxCoeff();
    const double squares = squares_sum(fits_.fit(beside.terms()), fit);
    const double sure = both(z / least_z_[s], squares / least_squares_[s]);
    return sure > least_of_both ? std::optional(error) : std::nullopt;
  }

  struct Best {
    std::size_t law = 0;
    Eigen::VectorXd error;
  };
  /// The stranger that predicts best beside `beside`, if it is significant.
  [[nodiscard]] std::optional<Best> best(const std::vector<Term>& beside) const {
    const FitsAround around(fits_, beside);
    std::optional<Best> found;
    for (const std::size_t s : shortlist(beside)) {
      const auto error = significant(s, around);
      if (error && !(found && found->error.sum() <= error->sum())) found = Best{s, *error};
    }
    return found;
  }

  /// Strangers that do for more names than they are. `named` is what all names leave; `taken_out`
  /// of these are in no term any more.
  void seek_fewer(const Eigen::VectorXd& named, std::size_t taken_out) {
    const std::size_t names = taken_out + names_left();
    if (names < 2) return;
    std::size_t fewest = names;
    double least = 0.0;
    std::vector<std::size_t> best_in;
    std::vector<bool> best_out = is_out_;
    for (const std::size_t first : shortlist({terms_.front()})) {
      std::fill(is_out_.begin(), is_out_.end(), false);
      in_ = {first};
      judge_again();
      std::optional<Eigen::VectorXd> error =
          significant(first, FitsAround(fits_, present(no_effect, first)));
      // One more as long as that makes fewer than there were.
      while (error && gain_of(*error, named).t > not_worse_t &&
             in_.size() + names_left() + 1 < names) {
        const std::optional<Best> next = best(present());
        if (!next) break;
        in_.push_back(next->law);
        judge_again();
        error = fits_.held_out(present());
      }
      const std::size_t laws = in_.size() + names_left();
      const bool fewer =
          laws < fewest || (!best_in.empty() && laws == fewest && error && error->sum() < least);
      if (!error || !fewer || gain_of(*error, named).t > not_worse_t) continue;
      fewest = laws;
      least = error->sum();
      best_in = in_;
      best_out = is_out_;
    }
    in_ = best_in;
    is_out_ = best_in.empty() ? std::vector<bool>(is_out_.size(), false) : best_out;
  }

  /// How many names that are terms are not out.
  [[nodiscard]] std::size_t names_left() const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < own_term_.size(); ++k) {
      if (own_term_[k] && !is_out_[k]) ++count;
    }
    return count;
  }

  /// Names in whose place a stranger does better.
  void exchange() {
    for (std::size_t k = 0; k < own_term_.size(); ++k) {
      if (!own_term_[k] || is_out_[k]) continue;
      const Eigen::VectorXd named = fits_.held_out(present());
      const std::vector<Term> others = present(k);
      const Eigen::VectorXd without = fits_.held_out(others);
      const std::optional<Best> rival = best(others);
      if (!rival) continue;
      if (!takes_the_place(named, rival->error, (without - named).sum())) {
        if (rival->error.sum() < named.sum()) {
          rivals_[k] = as_stranger(rival->law, others, without, rival->error);
        }
        continue;
      }
      is_out_[k] = true;
      in_.push_back(rival->law);
    }
  }

  void add() {
    while (const std::optional<Best> next = best(present())) in_.push_back(next->law);
  }

  /// Names that gain nothing beside the strangers, the worst first.
  void judge_again() {
    if (in_.empty()) return;
    while (true) {
      const FitsAround now(fits_, present());
      double least = keep_t;
      std::size_t worst = no_effect;
      for (std::size_t k = 0; k < own_term_.size(); ++k) {
        if (!own_term_[k] || is_out_[k]) continue;
        const double t = gain_of(now.without(place_of(k)), now.error()).t;
        if (t < least) {
          least = t;
          worst = k;
        }
      }
      if (worst == no_effect) return;
      is_out_[worst] = true;
    }
  }

  static constexpr double least_free_share = 1e-4;  // as for names: the data cannot see less

  const BlockFits& fits_;
  const std::vector<Term>& terms_;
  const std::vector<std::optional<std::size_t>>& own_term_;
  std::vector<std::size_t> laws_;  ///< modulations of the tally
  std::vector<Term> law_terms_;
  std::vector<double> least_z_;                  ///< one a law
  std::vector<double> least_squares_;            ///< likewise: what it must take away
  std::vector<std::size_t> in_;                  ///< of laws_
  std::vector<bool> is_out_;                     ///< of the effects
  std::vector<std::optional<Stranger>> rivals_;  ///< likewise
};

}  // namespace

std::string law_id(const Stranger& stranger, const Robot& robot) {
  std::string id = hypothesis_id(robot, stranger.carrier);
  if (stranger.law.signal == Signal::yield) id += " that yields";
  if (stranger.law.signal == Signal::play) id += " with play";
  return id;
}

std::string law_text(const Stranger& stranger, const Robot& robot) {
  if (stranger.law.of_gear()) return law_id(stranger, robot);
  return law_id(stranger, robot) + " over " +
         variable_of({stranger.law.signal, stranger.law.joint}, robot);
}

std::vector<AppliedEffect> carriers(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::vector<AppliedEffect> list;
  for (const AppliedEffect& h : all_hypotheses(robot)) {
    if (h.effect->site != SiteKind::joint) continue;
    if (h.effect->built_in || h.effect->needs_load_rate) continue;
    if (h.value.size() > 1 || h.shape.size() > 1) continue;
    if (!has_place_of(effects, h)) list.push_back(h);
  }
  for (int joint = 0; joint < robot.joint_count(); ++joint) {
    list.push_back(at_start(motor_ahead(), joint));
  }
  return list;
}

std::vector<AppliedEffect> ripple_carriers(const Robot& robot, const Recording& log,
                                           const Series& rigid, const Series& left) {
  const Effect& ripple = *find_effect("cogging");
  const ShapeNumber& N = ripple.shape.front();
  std::vector<AppliedEffect> list;
  for (int joint = 0; joint < robot.joint_count(); ++joint) {
    std::set<double> periods;
    for (const Series* of : {&rigid, &left}) {
      periods.insert(
          strongest_ripple(robot, log, *of, joint, joint, RippleOf::load, N.lower, N.upper));
    }
    for (const double period : periods) {
      list.push_back(at_start(ripple, joint));
      list.back().shape[0] = period;
    }
  }
  return list;
}

namespace {

/// Whether the joint's torque is seldom so light that noise decides its side: play of an unloaded
/// gear cannot be seen.
bool drives_from_a_side(const Recording& log, int joint) {
  constexpr double seldom = 0.1;  // of the samples
  const double light = light_load(log, joint);
  const auto count = std::count_if(log.samples().begin(), log.samples().end(),
                                   [&](const Sample& s) { return std::abs(s.tau[joint]) < light; });
  return static_cast<double>(count) < seldom * static_cast<double>(log.samples().size());
}

}  // namespace

std::vector<Modulation> modulated_carriers(const Recording& log,
                                           const std::vector<AppliedEffect>& hypotheses,
                                           std::size_t first, std::size_t last) {
  std::vector<Modulation> list;
  for (std::size_t k = first; k < last; ++k) {
    if (hypotheses[k].effect == &motor_ahead()) {
      list.push_back({k, Signal::yield, hypotheses[k].site});
      if (drives_from_a_side(log, hypotheses[k].site)) {
        list.push_back({k, Signal::play, hypotheses[k].site});
      }
      continue;
    }
    if (hypotheses[k].value.size() > 1) {
      list.push_back({k, Signal::load, hypotheses[k].site});
      continue;
    }
    for (const Signal signal : joint_signals) list.push_back({k, signal, hypotheses[k].site});
    list.push_back({k, Signal::time, hypotheses[k].site});
    if (hypotheses[k].effect->id != "torque_gain") continue;
    for (std::size_t level = 0; level < high_levels.size(); ++level) {
      list.push_back({k, Signal::peak, hypotheses[k].site, level});
    }
  }
  return list;
}

Contest contest(const Questions& asked) { return Ring(asked).run(); }

std::optional<Contest> contest_if_fewer(const Questions& asked, const Eigen::VectorXd& named,
                                        std::size_t taken_out) {
  return Ring(asked).run_if_fewer(named, taken_out);
}

std::optional<BestStranger> best_stranger(const Questions& asked) {
  return Ring(asked).best_beside_all();
}

bool takes_the_place(const Eigen::VectorXd& named, const Eigen::VectorXd& instead,
                     double own_gain) {
  return gain_of(named, instead).t > better_t &&
         (named - instead).sum() > material_share * own_gain;
}

}  // namespace shapeid::diagnosis
