#include "shapeid/diagnosis/usual.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/loop_state.hpp"

namespace shapeid::diagnosis {
namespace {

bool is_usual(const AppliedEffect& a) {
  static const std::array<std::string, 4> ids = {"viscous_friction", "coulomb_friction",
                                                 "torque_offset", "rotor_inertia"};
  return std::find(ids.begin(), ids.end(), a.effect->id) != ids.end();
}

}  // namespace

RichModel usual_model(const Robot& robot, const Recording& log, const LoopSettings& settings,
                      const LoopResult& loop) {
  LoopState state(robot, log, nullptr, settings);
  state.result.weight = loop.weight;
  state.result.prior = loop.prior;
  std::vector<AppliedEffect> effects;
  for (const AppliedEffect& a : all_hypotheses(robot)) {
    if (is_usual(a)) effects.push_back(a);
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
