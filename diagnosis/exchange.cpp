#include "shapeid/diagnosis/exchange.hpp"

#include <algorithm>
#include <cstddef>

#include "shapeid/diagnosis/candidates.hpp"

namespace shapeid::diagnosis {
namespace {

Term without(Term term, const Term& part) {
  std::erase_if(term.columns, [&](Eigen::Index column) {
    return std::count(part.columns.begin(), part.columns.end(), column) > 0;
  });
  term.nonnegative.assign(term.columns.size(), false);
  return term;
}

}  // namespace

void note_exchangeable(const BlockFits& fits, const Term& fixed, const std::vector<Candidate>& list,
                       const Selection& selection, LoopState& state) {
  const Tally& tally = fits.tally();
  const double most_force = state.rule().most_force;
  for (Found& f : state.result.found) {
    f.exchangeable.clear();
    const auto place =
        std::find_if(tally.hypotheses.begin(), tally.hypotheses.end(),
                     [&](const AppliedEffect& h) { return same_place(h, f.effect); });
    if (place == tally.hypotheses.end() || !state.is_applied_transformation(*place)) continue;
    const Term own =
        term_of(state.robot, tally, static_cast<std::size_t>(place - tally.hypotheses.begin()));
    std::vector<Term> others = {without(fixed, own)};
    for (const Verdict& v : selection.accepted) others.push_back(list[v.candidate].term);
    for (const std::size_t k : selection.hidden) {
      const Candidate& hidden = list[k];
      // The same at another time is no other cause.
      const AppliedEffect& h = hidden.effect;
      if (!hidden.members.empty() || same_law(h, f.effect)) continue;
      if (!(fits.contained(others, own, hidden.term) > nested_share)) continue;
      std::vector<Term> with = others;
      with.push_back(hidden.term);
      const Eigen::MatrixXd moves = fits.moves(with, {own}).front();
      const Eigen::VectorXd instead =
          moves.bottomRows(std::ssize(hidden.term.columns)) * f.effect.value;
      if (over_limit(*h.effect, instead, most_force) > 1.0) continue;
      f.exchangeable.push_back(hidden.term.id);
    }
  }
}

}  // namespace shapeid::diagnosis
