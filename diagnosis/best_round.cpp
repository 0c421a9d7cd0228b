#include "shapeid/diagnosis/best_round.hpp"

#include <cstddef>
#include <limits>

namespace shapeid::diagnosis {

std::size_t take_best_of(const std::vector<LoopResult>& rounds, LoopState& state) {
  const LoopResult last = state.result;
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    state.result = rounds[k];
    state.result.weight = last.weight;
    const double error = state.held_out_of_model().sum();
    if (error >= least) continue;
    least = error;
    best = k;
  }
  state.result = rounds[best];
  state.result.screening_seconds = last.screening_seconds;
  state.result.refit_seconds = last.refit_seconds;
  const LoopResult& taken = state.result;
  state.use_correction(taken.correction, taken.reference_correction);
  return best;
}

}  // namespace shapeid::diagnosis
