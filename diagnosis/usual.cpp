#include "shapeid/diagnosis/usual.hpp"

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {
RichModel usual_model(const Robot& robot, const Recording& log, const LoopSettings& settings,
                      const LoopResult& loop) {
  LoopState state(robot, log, nullptr, settings);
  state.result.weight = loop.weight;
  state.result.prior = loop.prior;
  std::vector<AppliedEffect> effects;
  for (const AppliedEffect& a : all_hypotheses(robot)) {
    if (a.effect->is_usual) effects.push_back(a);
  }
  const BlockFits fits = state.tallied(effects);
  std::vector<Term> terms = {state.masses};
  for (std::size_t k = 0; k < effects.size(); ++k) {
    terms.push_back(term_of(robot, fits.tally(), k));
  }
  const Fit fit = fits.fit(terms);
  state.set_masses(fit);
  Eigen::Index column = std::ssize(state.masses.columns);
  for (AppliedEffect& a : effects) {
    a.value = fit.value.segment(column, a.value.size());
    column += a.value.size();
  }
  return {state.result.model.Phi, effects, {}};
}

}  // namespace shapeid::diagnosis
