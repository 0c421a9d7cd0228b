#include "shapeid/diagnosis/verdicts.hpp"

#include <algorithm>
#include <utility>

#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/diagnosis/in_parallel.hpp"

namespace shapeid::diagnosis {
namespace {

// What cannot be negative must not be so by more than this many standard errors in a rival. In what
// is accepted it must not be at all; but of a rival's ten numbers one may, within its error.
constexpr double rival_sign_t = 2.0;
// Standard errors by which a rival must gain to be named in an accepted one's place. (Near the
// limit of acceptance chance decides which of two passes: a rival need only gain something.)
constexpr double rival_t = 1.0;

bool gains_something(const Gain& own) { return own.t > rival_t && own.share > 0.0; }

/// Whether its numbers are the parts of a vector: any direction of it is what it says, so that one
/// that is exactly another effect (the tilt about the axis of the first joint, its encoder's
/// offset) is no reason to keep silent about it. A spring without stiffness is no spring.
bool any_direction_is_one(const Effect& effect) {
  const auto& parameters = effect.parameters;
  return parameters.size() > 1 &&
         std::all_of(parameters.begin(), parameters.end(), [&](const Parameter& p) {
           return !p.nonnegative && p.unit == parameters.front().unit;
         });
}

/// `error` is not lower than this by more than what cannot be told apart.
bool as_good_as(const Eigen::VectorXd& error, const Eigen::VectorXd& instead) {
  return !(gain_of(instead, error).t > told_apart_t);
}

}  // namespace

std::vector<Verdict> Verdicts::of(const Chosen& accepted, const Eigen::VectorXd& error) const {
  std::vector<Verdict> verdicts(accepted.size());
  in_parallel(accepted.size(), rule_.threads, [&](std::size_t i) {
    Chosen others = accepted;
    std::erase(others, accepted[i]);
    verdicts[i] = one(accepted[i], others, error);
  });
  name_common_causes(accepted, error, verdicts);
  return verdicts;
}

Verdict Verdicts::one(std::size_t k, const Chosen& others, const Eigen::VectorXd& error) const {
  const FitsAround around(fits_, contenders_.terms(others));
  const Eigen::VectorXd& without = around.error();
  const Gain gain = credibility_.gain_by(k, without, error);
  Verdict verdict{k, gain.share, gain.t, true, contenders_.is_contained(k, others), {}, {}};
  // Of two times at one place the third says the same as either, with other numbers.
  const Chosen times = contenders_.of_other_times(k);
  const bool is_changed = std::ranges::any_of(
      times, [&](std::size_t other) { return contenders_.is_among(other, others); });
  for (const std::size_t other : is_changed ? Chosen{} : times) {
    const Eigen::VectorXd instead = around.with(contenders_[other].term);
    if (gains_something(gain_of(without, instead)) && as_good_as(error, instead) &&
        is_possible(other, others)) {
      verdict.other_times.push_back(contenders_[other].effect.when);
    }
  }
  for (const std::size_t rival : contenders_.rivals(others, rule_.rivals)) {
    // The same law with another width, or from the reference log on, is no other cause.
    if (contenders_.same_law(k, rival) || !contenders_[rival].members.empty()) continue;
    const Eigen::VectorXd instead = around.with(contenders_[rival].term);
    if (!gains_something(gain_of(without, instead))) continue;
    if (!as_good_as(error, instead) && !costs_its_numbers(rival, k, error, instead)) continue;
    const Fit own = fit_of(rival, others);
    // Something came since the reference log, and loads do. One that is a body is a load, whatever
    // the signs of its free numbers, and a cause of its own also where these contain k. (Of what
    // was always there a load is hardly ever the cause, and one of any size within a metre of a
    // link says much: it would be named with every rotor.)
    const auto is_body = [&] {
      return contenders_[k].effect.when != When::always &&
             contenders_[rival].effect.effect->is_payload &&
             credibility_.within_limits(rival, others, own);
    };
    if (credibility_.wrong_sign(rival, own, rival_sign_t) && !is_body()) continue;
    // The column of a gain holds all laws of its joint, k among them: a gain of one is k, with
    // masses that make up for the rest. (Loads are asked what bodies they are where it matters.)
    const bool is_load = contenders_[rival].effect.effect->is_payload;
    if (!is_load && !credibility_.within_limits(rival, others, own)) continue;
    // Two that say the same contain each other: that is no reason to keep silent about one.
    const auto within = [&](std::size_t inner, std::size_t outer) {
      return fits_.contained(contenders_.terms(others), contenders_[inner].term,
                             contenders_[outer].term) > nested_share;
    };
    const bool nested = within(k, rival) && !within(rival, k) &&
                        !any_direction_is_one(*contenders_[rival].effect.effect);
    if (!nested || is_body() || does_without(k, rival, others, error)) {
      verdict.ambiguous.push_back(rival);
    }
  }
  return verdict;
}

/// Whether a vector in the place of k is worse by no more than what its further numbers cost that
/// say nothing: up to the squares of three standard errors of each. A number of nothing costs a
/// little in every block, and blocks that agree are no evidence (of a tilt about the axis of the
/// first joint for its encoder's offset: three thousandths of the error, three standard errors).
bool Verdicts::costs_its_numbers(std::size_t rival, std::size_t k, const Eigen::VectorXd& error,
                                 const Eigen::VectorXd& instead) const {
  const std::size_t numbers = contenders_[rival].term.columns.size();
  const std::size_t own = contenders_[k].term.columns.size();
  if (numbers <= own || !any_direction_is_one(*contenders_[rival].effect.effect)) return false;
  constexpr double three_errors = 9.0;
  return instead.sum() - error.sum() <=
         three_errors * fits_.square_of_noise(error.sum()) * static_cast<double>(numbers - own);
}

/// Whether a rival that contains k does as well without the part that contains it: a spring
/// contains an offset, its torque at rest, but far from rest its stiffness alone may be what looks
/// like one. It then is a cause of its own, not k with a number on top.
bool Verdicts::does_without(std::size_t k, std::size_t rival, const Chosen& others,
                            const Eigen::VectorXd& error) const {
  const Candidate& whole = contenders_[rival];
  if (whole.effect.effect->is_payload || whole.term.columns.size() < 2) return false;
  const Eigen::VectorXd without = fits_.held_out(contenders_.terms(others));
  for (std::size_t i = 0; i < whole.term.columns.size(); ++i) {
    Term part = whole.term;
    part.columns.erase(part.columns.begin() + static_cast<std::ptrdiff_t>(i));
    part.nonnegative.erase(part.nonnegative.begin() + static_cast<std::ptrdiff_t>(i));
    std::vector<Term> list = contenders_.terms(others);
    if (fits_.contained(list, contenders_[k].term, part) > nested_share) continue;
    list.push_back(part);
    const Eigen::VectorXd instead = fits_.held_out(list);
    if (gains_something(gain_of(without, instead)) && as_good_as(error, instead)) return true;
  }
  return false;
}

/// What could take the place of several at once, and was not simpler, is named with each of them: a
/// load has more numbers than the two gains that it looks like.
void Verdicts::name_common_causes(const Chosen& accepted, const Eigen::VectorXd& error,
                                  std::vector<Verdict>& verdicts) const {
  if (accepted.size() < 2) return;
  for (const std::size_t rival : contenders_.rivals({}, rule_.rivals)) {
    if (contenders_.is_taken(rival, accepted) || !contenders_[rival].members.empty()) continue;
    const Chosen beside = not_superfluous_beside(rival, accepted);
    if (beside.size() + 1 >= accepted.size()) continue;
    const FitsAround around(fits_, contenders_.terms(beside));
    const Eigen::VectorXd instead = around.with(contenders_[rival].term);
    if (!gains_something(gain_of(around.error(), instead)) || !as_good_as(error, instead)) continue;
    const Fit own = fit_of(rival, beside);
    if (credibility_.wrong_sign(rival, own, rival_sign_t)) continue;
    if (!credibility_.within_limits(rival, beside, own)) continue;
    for (std::size_t i = 0; i < accepted.size(); ++i) {
      Chosen& named = verdicts[i].ambiguous;
      if (contenders_.same_law(accepted[i], rival)) continue;  // other times are asked on their own
      if (!contenders_.is_among(accepted[i], beside) && !contenders_.is_among(rival, named)) {
        named.push_back(rival);
      }
    }
  }
}

bool Verdicts::is_possible(std::size_t k, const Chosen& others) const {
  const Fit own = fit_of(k, others);
  const bool is_load = contenders_[k].effect.effect->is_payload;
  return (is_load || !credibility_.wrong_sign(k, own, rival_sign_t)) &&
         credibility_.within_limits(k, others, own);
}

Fit Verdicts::fit_of(std::size_t rival, const Chosen& others) const {
  return contenders_.last_of(rival, fits_.fit(contenders_.terms(others, rival)));
}

/// Those of `chosen` that gain something beside them all and the rival.
Chosen Verdicts::not_superfluous_beside(std::size_t rival, Chosen chosen) const {
  while (!chosen.empty()) {
    const FitsAround now(fits_, contenders_.terms(chosen, rival));
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

}  // namespace shapeid::diagnosis
