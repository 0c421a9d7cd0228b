// The order of relaxations on every window: Linear <= Nonlinear <= Full <= shapes.
#pragma once

#include <string>

#include "shapeid/tests/experiments/page/findings.hpp"
#include "shapeid/tests/experiments/studies/contest.hpp"

namespace shapeid::experiments {

/// Counts over windows. Optima are known with their floors, so that what is not converged cannot
/// pass for an optimum.
struct OrderCount {
  int windows = 0;
  /// Windows on which a larger set's floor is above a smaller set's value: impossible.
  int contradictions = 0;
  double worst_gap = 0.0;  ///< of Linear, Full, Points and Ours, over || F ||^2

  /// A nonlinear solver beside the optimum of its own set.
  struct Stalled {
    int stopped_short = 0;   ///< f more than a hundredth above the set's floor
    int said_converged = 0;  ///< of these, where the solver reported convergence
    int above_full = 0;      ///< f above Full's optimum: the order looks broken
    int above_shapes = 0;    ///< f above Ours
    double worst = 0.0;      ///< largest share above the floor
  };
  Stalled usual, hard, log_cholesky;
};

void count_order(const Setting& setting, const std::vector<TimedWindow>& windows,
                 OrderCount& count);

/// Numbers "order.NAME.*".
void report(const std::string& name, const OrderCount& count, Findings& findings);

}  // namespace shapeid::experiments
