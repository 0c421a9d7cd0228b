#include "shapeid/diagnosis/contest.hpp"

#include <algorithm>

#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/diagnosis/selection.hpp"
#include "shapeid/diagnosis/stranger_laws.hpp"

namespace shapeid::diagnosis {
namespace {

// Standard errors by which a stranger must predict better to take a name's place.
constexpr double better_t = 2.0;

class Ring {
 public:
  explicit Ring(const Questions& asked)
      : fits_(asked.fits),
        terms_(asked.terms),
        own_term_(asked.own_term),
        laws_(asked),
        is_out_(asked.effects(), false),
        rivals_(asked.effects()) {}

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
    const std::optional<StrangerLaws::Best> found = laws_.best(present(), in_);
    if (!found) return std::nullopt;
    return BestStranger{
        laws_.as_stranger(found->law, present(), fits_.held_out(present()), found->error),
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
      result.strangers.push_back(laws_.as_stranger(s, others, fits_.held_out(others), with_all));
    }
    std::stable_sort(result.strangers.begin(), result.strangers.end(),
                     [](const Stranger& a, const Stranger& b) { return a.gain > b.gain; });
    return result;
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
      if (s != without_law) list.push_back(laws_.term(s));
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

  /// Strangers that do for more names than they are. `named` is what all names leave; `taken_out`
  /// of these are in no term any more.
  void seek_fewer(const Eigen::VectorXd& named, std::size_t taken_out) {
    const std::size_t names = taken_out + names_left();
    if (names < 2) return;
    std::size_t fewest = names;
    double least = 0.0;
    std::vector<std::size_t> best_in;
    std::vector<bool> best_out = is_out_;
    for (const std::size_t first : laws_.shortlist({terms_.front()}, in_)) {
      std::fill(is_out_.begin(), is_out_.end(), false);
      in_ = {first};
      judge_again();
      std::optional<Eigen::VectorXd> error =
          laws_.significant(first, FitsAround(fits_, present(no_effect, first)));
      // One more as long as that makes fewer than there were.
      while (error && gain_of(*error, named).t > not_worse_t &&
             in_.size() + names_left() + 1 < names) {
        const std::optional<StrangerLaws::Best> next = laws_.best(present(), in_);
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
      const std::optional<StrangerLaws::Best> rival = laws_.best(others, in_);
      if (!rival) continue;
      if (!takes_the_place(named, rival->error, (without - named).sum())) {
        if (rival->error.sum() < named.sum()) {
          rivals_[k] = laws_.as_stranger(rival->law, others, without, rival->error);
        }
        continue;
      }
      is_out_[k] = true;
      in_.push_back(rival->law);
    }
  }

  void add() {
    while (const std::optional<StrangerLaws::Best> next = laws_.best(present(), in_)) {
      in_.push_back(next->law);
    }
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

  const BlockFits& fits_;
  const std::vector<Term>& terms_;
  const std::vector<std::optional<std::size_t>>& own_term_;
  StrangerLaws laws_;
  std::vector<std::size_t> in_;                  ///< of the laws
  std::vector<bool> is_out_;                     ///< of the effects
  std::vector<std::optional<Stranger>> rivals_;  ///< likewise
};

}  // namespace

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
