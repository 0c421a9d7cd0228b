#include "shapeid/diagnosis/large_transformation.hpp"

#include <algorithm>
#include <cstddef>

namespace shapeid::diagnosis {
namespace {

/// Fewer numbers, unless they predict worse; of as many, what predicts better.
bool is_preferred(const Candidate& one, const Eigen::VectorXd& error, const Candidate& other,
                  const Eigen::VectorXd& other_error) {
  const std::size_t numbers = one.term.columns.size(), others = other.term.columns.size();
  if (numbers < others) return !(gain_of(error, other_error).t > not_worse_t);
  if (numbers > others) return gain_of(other_error, error).t > not_worse_t;
  return error.sum() < other_error.sum();
}

bool is_accepted(std::size_t k, const Selection& selection) {
  return std::ranges::count(selection.accepted, k, &Verdict::candidate) > 0;
}

std::optional<Candidate> best_beside(const BlockFits& fits, const std::vector<Term>& beside,
                                     const std::vector<Candidate>& list,
                                     const Selection& selection) {
  // Half of it was asked until a delay of 10 ms, as its derivative, took 46 % of what two lags
  // did, and all when it was applied.
  constexpr double much = 0.3;
  const double before = fits.held_out(beside).sum();
  const double enough = before - much * (before - selection.error_end.sum());
  std::optional<Candidate> best;
  Eigen::VectorXd least;  // of the best
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Candidate& c = list[k];
    if (!c.effect.effect->transform.any() || c.effect.when != When::always ||
        is_accepted(k, selection)) {
      continue;
    }
    std::vector<Term> with = beside;
    with.push_back(c.term);
    const Eigen::VectorXd error = fits.held_out(with);
    if (!(error.sum() < enough)) continue;
    if (best && !is_preferred(c, error, *best, least)) continue;
    least = error;
    best = c;
  }
  return best;
}

}  // namespace

std::optional<Candidate> large_transformation(const BlockFits& fits, const Term& fixed,
                                              const std::vector<Candidate>& list,
                                              const Selection& selection) {
  if (selection.accepted.size() < 2) return std::nullopt;
  std::optional<Candidate> alone = best_beside(fits, {fixed}, list, selection);
  if (alone) return alone;
  const Verdict& strongest = *std::ranges::max_element(selection.accepted, {}, &Verdict::gain);
  return best_beside(fits, {fixed, list[strongest.candidate].term}, list, selection);
}

}  // namespace shapeid::diagnosis
