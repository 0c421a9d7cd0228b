#include "shapeid/diagnosis/stranger_laws.hpp"

#include <algorithm>

#include "shapeid/diagnosis/chance.hpp"
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

}  // namespace

StrangerLaws::StrangerLaws(const Questions& asked) : fits_(asked.fits) {
  const Tally& tally = fits_.tally();
  double parameters = 0.0;
  for (std::size_t k = 0; k < tally.modulations.size(); ++k) {
    const Modulation& m = tally.modulations[k];
    const AppliedEffect& carrier = tally.hypotheses[m.hypothesis];
    const bool is_law = m.hypothesis < asked.effects() || m.hypothesis >= asked.first_carrier;
    if (!is_law || carrier.effect->site != SiteKind::joint) continue;
    laws_.push_back(k);
    Term& term = terms_.emplace_back();
    fits_.limit_to_time_of(carrier, term);
    const Eigen::Index count = m.columns_of(carrier.value.size());
    for (Eigen::Index p = 0; p < count; ++p) {
      term.columns.push_back(tally.first_modulated[k] + p);
      term.nonnegative.push_back(m.of_gear());
    }
    parameters += static_cast<double>(count);
  }
  for (const std::size_t k : laws_) {
    const double tried = parameters * asked.choices[tally.modulations[k].hypothesis];
    least_z_.push_back(limit_for(least_z(false_alarms, tried), fits_.blocks() / blocks_for_one));
    least_squares_.push_back(
        least_squares_sum(false_alarms / tried, std::ssize(terms_[least_squares_.size()].columns)));
  }
}

std::vector<std::size_t> StrangerLaws::shortlist(const std::vector<Term>& beside,
                                                 const std::vector<std::size_t>& taken) const {
  const auto promises = fits_.promises(beside, terms_);
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < laws_.size(); ++s) {
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](std::size_t other) {
      return law(other).joint == law(s).joint;
    });
    if (!is_taken && !promises[s].hidden()) order.push_back(s);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return promises[a].gain > promises[b].gain;
  });
  order.resize(std::min(order.size(), shortlist_length));
  return order;
}

std::optional<Eigen::VectorXd> StrangerLaws::significant(std::size_t s,
                                                         const FitsAround& beside) const {
  Eigen::VectorXd error = beside.with(terms_[s]);
  const Gain gain = gain_of(beside.error(), error);
  const bool of_gear = law(s).of_gear();
  if (!(gain.t > (of_gear ? least_t_of_gear : least_t) && gain.share > 0.0)) return std::nullopt;
  std::vector<Term> with = beside.terms();
  with.push_back(terms_[s]);
  const Fit fit = fits_.fit(with);
  const Eigen::Index n = std::ssize(terms_[s].columns);
  if (terms_[s].nonnegative[0] && fit.value.tail(n)[0] < 0.0) return std::nullopt;
  const double z = errors_from_zero(fit.value.tail(n), fit.between_blocks.tail(n)).abs().maxCoeff();
  const double squares = squares_sum(fits_.fit(beside.terms()), fit);
  const double sure = both(z / least_z_[s], squares / least_squares_[s]);
  return sure > least_of_both ? std::optional(error) : std::nullopt;
}

std::optional<StrangerLaws::Best> StrangerLaws::best(const std::vector<Term>& beside,
                                                     const std::vector<std::size_t>& taken) const {
  const FitsAround around(fits_, beside);
  std::optional<Best> found;
  for (const std::size_t s : shortlist(beside, taken)) {
    const auto error = significant(s, around);
    if (error && !(found && found->error.sum() <= error->sum())) found = Best{s, *error};
  }
  return found;
}

Stranger StrangerLaws::as_stranger(std::size_t s, std::vector<Term> beside,
                                   const Eigen::VectorXd& before,
                                   const Eigen::VectorXd& after) const {
  const Gain gain = gain_of(before, after);
  beside.push_back(terms_[s]);
  const Eigen::VectorXd value = fits_.fit(beside).value;
  const double number = value[value.size() - std::ssize(terms_[s].columns)];
  return {law(s), fits_.tally().hypotheses[law(s).hypothesis], gain.share, gain.t, number};
}

}  // namespace shapeid::diagnosis
