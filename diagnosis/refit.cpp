#include "shapeid/diagnosis/refit.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/refine.hpp"

namespace shapeid::diagnosis {
namespace {

bool needs_refit(const std::vector<Found>& found) {
  return std::any_of(found.begin(), found.end(), [](const Found& f) {
    const bool filters = f.effect.effect->filters_load && !f.effect.to_first_order;
    return f.effect.effect->transform.any() || f.effect.shape.size() > 0 || filters;
  });
}

using VariantsOf = std::function<std::vector<AppliedEffect>(const AppliedEffect&)>;

/// All numbers at once, of each effect as the variant that predicts best.
void refit_among(LoopState& state, const VariantsOf& variants_of) {
  std::vector<Found>& found = state.result.found;
  std::vector<AppliedEffect> variants;
  std::vector<std::vector<std::size_t>> of_found(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const AppliedEffect& a : variants_of(found[i].effect)) {
      of_found[i].push_back(variants.size());
      variants.push_back(a);
    }
  }
  const BlockFits fits = state.tallied(variants);
  std::vector<std::vector<Term>> choices;
  for (std::size_t i = 0; i < of_found.size(); ++i) {
    auto& terms = choices.emplace_back();
    for (const std::size_t v : of_found[i]) {
      terms.push_back(term_of(state.robot, fits.tally(), v));
      fits.limit_to_time_of(found[i].effect, terms.back());
    }
  }
  const std::vector<std::size_t> chosen = best_variants(fits, state.masses, choices);
  std::vector<Term> terms = {state.masses};
  for (std::size_t i = 0; i < choices.size(); ++i) terms.push_back(choices[i][chosen[i]]);
  const Fit fit = fits.fit(terms);
  state.set_masses(fit);
  Eigen::Index column = std::ssize(state.masses.columns);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    AppliedEffect& a = found[i].effect;
    const Eigen::Index n = a.value.size();
    const Eigen::VectorXd value = fit.value.segment(column, n);
    a.shape = variants[of_found[i][chosen[i]]].shape;
    a.value = a.effect->transform.any() ? Eigen::VectorXd(a.value + value) : value;
    found[i].standard_error = fit.standard_error.segment(column, n);
    column += n;
  }
  state.collect_effects();
}

}  // namespace

void refit(LoopState& state) {
  constexpr int passes = 3;
  for (int pass = 0; pass < passes && needs_refit(state.result.found); ++pass) {
    refit_among(state, [&](const AppliedEffect& a) {
      return shape_variants(a, pass, state.tally_options.block_seconds);
    });
  }
}

void refit_from_afar(LoopState& state, std::size_t i) {
  const AppliedEffect moved = state.result.found.at(i).effect;
  refit_among(state, [&moved](const AppliedEffect& a) {
    return same_place(a, moved) ? distant_variants(a) : std::vector<AppliedEffect>{a};
  });
  refit(state);
}

void refit_numbers(LoopState& state) {
  refit_among(state, [](const AppliedEffect& a) { return std::vector<AppliedEffect>{a}; });
}

}  // namespace shapeid::diagnosis
