#include "shapeid/diagnosis/causes_alone.hpp"

#include <algorithm>

namespace shapeid::diagnosis {

std::optional<Consistent> beside_causes_alone(const Robot& robot, const Recording& log,
                                              const Recording* reference,
                                              const LoopSettings& settings,
                                              const LoopResult& loop) {
  const auto describes = [](const Found& f) { return !f.name_stands() && !f.needed; };
  if (std::none_of(loop.found.begin(), loop.found.end(), describes)) return std::nullopt;
  LoopResult causes = loop;
  std::erase_if(causes.found, describes);
  causes.model.effects.clear();
  for (const Found& f : causes.found) causes.model.effects.push_back(f.effect);
  return make_consistent(robot, log, reference, settings, causes);
}

std::optional<Eigen::Index> hangs_on_descriptions(const Consistent& model,
                                                  const Consistent& causes_alone, int link) {
  constexpr double told_apart = 3.0;  // standard errors; ten numbers a link are looked at
  const Eigen::Index at = Eigen::Index{10} * link;
  const Eigen::ArrayXd moved =
      (model.model.Phi.segment<10>(at) - causes_alone.model.Phi.segment<10>(at)).cwiseAbs();
  const Eigen::ArrayXd error = (model.Phi_error.segment<10>(at).cwiseAbs2() +
                                causes_alone.Phi_error.segment<10>(at).cwiseAbs2())
                                   .cwiseSqrt();
  // What nothing but the prior holds has no scatter: it moves by the solver's tolerance.
  constexpr double tolerance = 1e-6;
  const Eigen::ArrayXd size = model.model.Phi.segment<10>(at).cwiseAbs();
  std::optional<Eigen::Index> worst;
  for (Eigen::Index p = 0; p < moved.size(); ++p) {
    if (!(moved[p] > told_apart * error[p] && moved[p] > tolerance * size[p])) continue;
    if (!worst || moved[p] * error[*worst] > moved[*worst] * error[p]) worst = p;
  }
  return worst;
}

}  // namespace shapeid::diagnosis
