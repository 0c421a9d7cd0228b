#include "shapeid/diagnosis/credibility.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/chance.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {
namespace {

// By how much both measures together must exceed what chance makes of nothing. (Of 159 clean logs
// of blind trials none had more than 0.95, a length and a lag that had been named in others 0.96
// and less. Of 162 single effects of two and four times the detectable size two had less than 1.1.)
constexpr double least_of_both = 1.1;

// Of what ten free numbers explain, the share that no body explains and a load's name may lack.
constexpr double most_lost_share = 0.1;

}  // namespace

double differs_from_zero(const Effect& effect, const Eigen::VectorXd& value,
                         const Eigen::VectorXd& error, double choices) {
  if (choices > 1.0) return value.norm() / error.maxCoeff();
  const Eigen::ArrayXd each = errors_from_zero(value, error);
  constexpr Eigen::Index mass_and_moments = 4;
  const Eigen::Index asked =
      effect.is_payload ? std::min(mass_and_moments, each.size()) : each.size();
  return each.head(asked).abs().maxCoeff();
}

Credibility::Credibility(const BlockFits& fits, const Contenders& contenders,
                         const SelectionRule& rule)
    : fits_(fits),
      contenders_(contenders),
      rule_(rule),
      limit_(limit_for(rule.least_t, fits.blocks())),
      parameters_(contenders.parameters()) {}

bool Credibility::wrong_sign(std::size_t k, const Fit& own, double least_t) const {
  const auto& nonnegative = contenders_[k].term.nonnegative;
  for (std::size_t i = 0; i < nonnegative.size(); ++i) {
    const auto p = static_cast<Eigen::Index>(i);
    if (nonnegative[i] && own.value[p] < -least_t * own.standard_error[p]) return true;
  }
  return false;
}

bool Credibility::within_limits(std::size_t k, const Chosen& others, const Fit& own) const {
  const Effect& effect = *contenders_[k].effect.effect;
  if (effect.is_payload) {
    const MostLost most = most_lost(k, own);
    return most.allows(best_body(beside(k, others), contenders_[k].room, most));
  }
  Eigen::VectorXd value = own.value;
  // The column of a transformation is that of a change.
  if (effect.transform.any()) value += contenders_[k].effect.value;
  return !(over_limit(effect, value, rule_.most_force) > 1.0);
}

BlockFits::Beside Credibility::beside(std::size_t k, const Chosen& others) const {
  return fits_.beside(contenders_.terms(others), contenders_[k].term);
}

MostLost Credibility::most_lost(std::size_t k, const Fit& own) const {
  const double by_chance =
      own.left / own.freedom *
      least_squares_sum(rule_.false_alarms, fits_.numbers_shown(contenders_[k].term));
  return {by_chance, most_lost_share};
}

bool Credibility::credible(std::size_t k, const Chosen& others, const Fit& without,
                           const Fit& with) const {
  const double tried = parameters_ * contenders_[k].choices;
  if (!contenders_[k].members.empty()) {
    return std::sqrt(squares_over_chance(k, without, with, tried)) > least_of_both;
  }
  const Fit own = contenders_.last_of(k, with);
  const double over = over_chance(k, without, with, own, tried);
  if (!contenders_[k].effect.effect->is_payload) {
    return over > least_of_both && within_limits(k, others, own);
  }
  const LoadBody body = best_body(beside(k, others), contenders_[k].room);
  if (!most_lost(k, own).allows(body)) return false;
  // Its numbers say the same in part, and each by itself may be any: as a body it is one.
  const Eigen::Index shown = fits_.numbers_shown(contenders_[k].term);
  const double limit =
      limit_for(std::sqrt(least_squares_sum(rule_.false_alarms / tried, shown)), fits_.blocks());
  const double t =
      fits_.along(contenders_.terms(others), contenders_[k].term, body.Phi).t() / limit;
  return std::max(over, both(t, squares_over_chance(k, without, with, tried))) > least_of_both;
}

bool Credibility::ripples(std::size_t k, const Chosen& others, const Fit& all,
                          const Fit& own) const {
  const double tried = parameters_ * contenders_[k].choices;
  return over_chance(k, fits_.fit(contenders_.terms(others)), all, own, tried) > least_of_both;
}

bool Credibility::is_by_itself(std::size_t k, const Chosen& others, double numbers) const {
  const Fit all = fits_.fit(contenders_.terms(others, k));
  return over_chance(k, fits_.fit(contenders_.terms(others)), all, contenders_.last_of(k, all),
                     numbers) > least_of_both;
}

Gain Credibility::gain_by(std::size_t k, const Eigen::VectorXd& before,
                          const Eigen::VectorXd& after) const {
  Gain gain = gain_of(before, after);
  const Term& term = contenders_[k].term;
  const auto from = static_cast<Eigen::Index>(term.from_block);
  const auto to = static_cast<Eigen::Index>(std::min(term.to_block, fits_.tally().blocks.size()));
  const Eigen::Index acts = to - from;
  if (acts == before.size()) return gain;
  const double t = gain_of(before.segment(from, acts), after.segment(from, acts)).t;
  gain.t = std::max(gain.t, t * limit_ / limit_for(rule_.least_t, acts));
  return gain;
}

/// Of so many numbers that are tried.
double Credibility::squares_over_chance(std::size_t k, const Fit& without, const Fit& with,
                                        double tried) const {
  return std::max(0.0, squares_sum(without, with)) /
         least_squares_sum(rule_.false_alarms / tried, fits_.numbers_shown(contenders_[k].term));
}

double Credibility::over_chance(std::size_t k, const Fit& without, const Fit& with, const Fit& own,
                                double tried) const {
  const double limit = limit_for(least_z(rule_.false_alarms, tried), fits_.blocks());
  const Candidate& candidate = contenders_[k];
  const double differs =
      differs_from_zero(*candidate.effect.effect, own.value, own.between_blocks, candidate.choices);
  return both(differs / limit, squares_over_chance(k, without, with, tried));
}

}  // namespace shapeid::diagnosis
