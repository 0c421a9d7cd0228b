#include "shapeid/diagnosis/strangers.hpp"

#include <algorithm>
#include <numeric>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/selection.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double false_alarms =
    0.01;  // logs without any in which chance makes one of all that are tried
constexpr std::size_t shortlist_length = 12;
// Standard errors of held-out gain: more than of a name, because more laws are tried, and products
// of signals resemble the filter's errors. (In blind trials chance reached 2.8 on clean logs, what
// was there at twice the detectable size 3.2 and more, but for one ripple.)
constexpr double least_t = 3.0;
// Neighbouring blocks are correlated, and errors from so few are uncertain: they count as half as
// many. (Among 36 clean logs one in six had a law of more than 4.5 standard errors, none that
// passed `least_t` of more than 5.1.)
constexpr Eigen::Index blocks_for_one = 2;
// Standard errors by which a stranger must predict better to take a name's place.
constexpr double better_t = 2.0;

class Ring {
 public:
  Ring(const BlockFits& fits, const std::vector<Term>& terms,
       const std::vector<std::optional<std::size_t>>& own_term, std::size_t first_carrier)
      : fits_(fits), terms_(terms), own_term_(own_term), is_out_(own_term.size(), false) {
    const Tally& tally = fits.tally();
    const std::size_t effects = own_term.size();
    for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
      const Modulation& m = tally.modulations[k];
      const AppliedEffect& carrier = tally.hypotheses[m.hypothesis];
      const bool is_law = m.hypothesis < effects || m.hypothesis >= first_carrier;
      if (!is_law || carrier.effect->site != SiteKind::joint) continue;
      laws_.push_back(k);
      Term& term = law_terms_.emplace_back();
      for (Eigen::Index p = 0; p < carrier.value.size(); ++p) {
        term.columns.push_back(tally.first_modulated[k] + p);
        term.nonnegative.push_back(false);
      }
      parameters_ += static_cast<double>(carrier.value.size());
    }
    least_z_ = limit_for(least_z(false_alarms, parameters_), fits.held_blocks() / blocks_for_one);
  }

  Contest run() {
    exchange();
    add();
    judge_again();
    Contest result;
    result.displaced = is_out_;
    const Eigen::VectorXd with_all = fits_.held_out(present());
    for (const std::size_t s : in_) {
      const Gain gain = gain_of(fits_.held_out(present(no_effect, s)), with_all);
      const Modulation& law = fits_.tally().modulations[laws_[s]];
      result.strangers.push_back(
          {law, fits_.tally().hypotheses[law.hypothesis], gain.share, gain.t});
    }
    std::stable_sort(result.strangers.begin(), result.strangers.end(),
                     [](const Stranger& a, const Stranger& b) { return a.gain > b.gain; });
    return result;
  }

  [[nodiscard]] std::optional<Eigen::VectorXd> best_beside_all() const {
    const std::optional<Best> found = best(present());
    return found ? std::optional(found->error) : std::nullopt;
  }

 private:
  static constexpr std::size_t no_effect = static_cast<std::size_t>(-1);

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

  struct Best {
    std::size_t law = 0;
    Eigen::VectorXd error;
    Gain gain;
  };
  /// The stranger that predicts best beside `beside`, if it is significant.
  [[nodiscard]] std::optional<Best> best(const std::vector<Term>& beside) const {
    const Eigen::VectorXd before = fits_.held_out(beside);
    std::optional<Best> found;
    for (const std::size_t s : shortlist(beside)) {
      std::vector<Term> with = beside;
      with.push_back(law_terms_[s]);
      const Eigen::VectorXd error = fits_.held_out(with);
      const Gain gain = gain_of(before, error);
      if (!(gain.t > least_t && gain.share > 0.0)) continue;
      if (found && found->error.sum() <= error.sum()) continue;
      const Fit fit = fits_.fit(with);
      const Eigen::Index n = std::ssize(law_terms_[s].columns);
      const double z =
          (fit.value.tail(n).array() / fit.standard_error.tail(n).array()).abs().maxCoeff();
      if (z > least_z_) found = Best{s, error, gain};
    }
    return found;
  }

  /// Names in whose place a stranger does better.
  void exchange() {
    for (std::size_t k = 0; k < own_term_.size(); ++k) {
      if (!own_term_[k]) continue;
      const Eigen::VectorXd named = fits_.held_out(present());
      const std::vector<Term> others = present(k);
      const double own_gain = (fits_.held_out(others) - named).sum();
      const std::optional<Best> rival = best(others);
      if (!rival) continue;
      if (!takes_the_place(named, rival->error, own_gain)) continue;
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
      const Eigen::VectorXd with_all = fits_.held_out(present());
      double least = keep_t;
      std::size_t worst = no_effect;
      for (std::size_t k = 0; k < own_term_.size(); ++k) {
        if (!own_term_[k] || is_out_[k]) continue;
        const double t = gain_of(fits_.held_out(present(k)), with_all).t;
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
  std::vector<std::size_t> in_;  ///< of laws_
  std::vector<bool> is_out_;     ///< of the effects
  double parameters_ = 0.0, least_z_ = 0.0;
};

}  // namespace

std::vector<AppliedEffect> carriers(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::vector<AppliedEffect> list;
  for (const AppliedEffect& h : all_hypotheses(robot)) {
    if (h.effect->site != SiteKind::joint) continue;
    if (h.effect->built_in || h.effect->needs_load_rate) continue;
    if (h.value.size() > 1 || h.shape.size() > 1) continue;
    const bool known = std::any_of(effects.begin(), effects.end(),
                                   [&](const AppliedEffect& a) { return same_place(a, h); });
    if (!known) list.push_back(h);
  }
  return list;
}

std::vector<Modulation> modulated_carriers(const std::vector<AppliedEffect>& hypotheses,
                                           std::size_t first, std::size_t last) {
  std::vector<Modulation> list;
  for (std::size_t k = first; k < last; ++k) {
    for (const Signal signal : joint_signals) list.push_back({k, signal, hypotheses[k].site});
    list.push_back({k, Signal::time, hypotheses[k].site});
  }
  return list;
}

Contest contest(const BlockFits& fits, const std::vector<Term>& terms,
                const std::vector<std::optional<std::size_t>>& own_term,
                std::size_t first_carrier) {
  return Ring(fits, terms, own_term, first_carrier).run();
}

std::optional<Eigen::VectorXd> with_best_stranger(const BlockFits& fits,
                                                  const std::vector<Term>& terms,
                                                  std::size_t effects, std::size_t first_carrier) {
  const std::vector<std::optional<std::size_t>> none(effects);
  return Ring(fits, terms, none, first_carrier).best_beside_all();
}

bool takes_the_place(const Eigen::VectorXd& named, const Eigen::VectorXd& instead,
                     double own_gain) {
  return gain_of(named, instead).t > better_t &&
         (named - instead).sum() > material_share * own_gain;
}

}  // namespace shapeid::diagnosis
