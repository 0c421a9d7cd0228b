#include "shapeid/diagnosis/take_selection.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "shapeid/diagnosis/candidates.hpp"

namespace shapeid::diagnosis {
namespace {

std::vector<Ranked> ranked(const std::vector<Candidate>& list, const std::vector<Scored>& scores) {
  std::vector<Ranked> ranking;
  ranking.reserve(scores.size());
  for (const Scored& s : scores) {
    ranking.push_back({list[s.candidate].term.id, s.gain, s.t, s.credible});
  }
  return ranking;
}

/// Gauss-Newton: applied transformations move by what their columns were fitted with.
void step_transformations(const Tally& tally, const Term& fixed, const Fit& fit, LoopState& state) {
  auto column = std::ssize(state.masses.columns);
  for (std::size_t k = 0; k < tally.hypotheses.size() && column < std::ssize(fixed.columns); ++k) {
    if (!state.is_applied_transformation(tally.hypotheses[k])) continue;
    for (Found& f : state.result.found) {
      if (!same_place(f.effect, tally.hypotheses[k])) continue;
      const Eigen::Index n = f.effect.value.size();
      f.effect.value += fit.value.segment(column, n);
      f.standard_error = fit.standard_error.segment(column, n);
      column += n;
    }
  }
}

/// Each once: what cannot be told in either log. Of what came or went the other log may know all;
/// and what has been found at another time hides itself, and is known.
std::vector<std::string> ids_of_hidden(const BlockFits& fits, const Term& fixed,
                                       const std::vector<Candidate>& list,
                                       const Selection& selection) {
  std::vector<std::string> ids;
  for (const std::size_t k : selection.hidden) {
    const Candidate& hidden = list[k];
    const bool asked_of_both = std::ranges::any_of(list, [&](const Candidate& c) {
      return same_law(c.effect, hidden.effect) && c.effect.when == When::always;
    });
    if (asked_of_both && hidden.effect.when != When::always) continue;
    std::vector<Term> others = {fixed};
    bool is_found = false;
    for (const Verdict& v : selection.accepted) {
      const bool same = same_law(list[v.candidate].effect, hidden.effect);
      is_found = is_found || same;
      if (!same) others.push_back(list[v.candidate].term);
    }
    if (is_found && !fits.promises(others, {hidden.term}).front().hidden()) continue;
    if (std::ranges::find(ids, hidden.term.id) == ids.end()) ids.push_back(hidden.term.id);
  }
  return ids;
}

}  // namespace

void take_selection(const BlockFits& fits, const Term& fixed, const std::vector<Candidate>& list,
                    const Selection& selection, LoopState& state) {
  LoopResult& result = state.result;
  // Transformations that are applied already stay as they were judged.
  std::erase_if(result.found, [](const Found& f) { return !f.effect.effect->transform.any(); });
  Eigen::Index column = std::ssize(fixed.columns);
  for (const Verdict& verdict : selection.accepted) {
    const Candidate& candidate = list[verdict.candidate];
    const Eigen::Index n = std::ssize(candidate.term.columns);
    Found found{candidate.effect, candidate.term.id,
                selection.fit.standard_error.segment(column, n), verdict.gain, verdict.t};
    found.effect.value = selection.fit.value.segment(column, n);
    found.only_with_others = !verdict.by_itself;
    found.hangs_on_given = verdict.hangs_on_given;
    found.other_times = verdict.other_times;
    column += n;
    auto& names = found.ambiguous_with;
    for (const std::size_t k : verdict.ambiguous) names.push_back(list[k].term.id);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    result.found.push_back(found);
  }
  state.set_masses(selection.fit);
  step_transformations(fits.tally(), fixed, selection.fit, state);
  state.collect_effects();
  result.hypotheses = static_cast<std::size_t>(
      std::count_if(list.begin(), list.end(), [](const Candidate& c) { return !c.only_rival; }));
  result.last_ranking = ranked(list, selection.last_ranking);
  result.hidden = ids_of_hidden(fits, fixed, list, selection);
  result.wrong_signs.clear();
  for (const Scored& s : selection.wrong_signs) {
    const Term& term = list[s.candidate].term;
    double lowest = 0.0;  // standard errors, of the numbers that cannot be negative
    for (Eigen::Index p = 0; p < std::ssize(term.columns); ++p) {
      if (!term.nonnegative[static_cast<std::size_t>(p)]) continue;
      lowest = std::min(lowest, s.fit.value[p] / s.fit.standard_error[p]);
    }
    result.wrong_signs.emplace_back(term.id, lowest);
  }
}

void note_first_ranking(const std::vector<Candidate>& list, const Selection& selection,
                        LoopResult& result) {
  if (selection.steps.empty()) return;
  std::vector<Scored> first = selection.steps.front().others;
  first.insert(first.begin(), selection.steps.front().accepted);
  result.first_ranking = ranked(list, first);
}

}  // namespace shapeid::diagnosis
