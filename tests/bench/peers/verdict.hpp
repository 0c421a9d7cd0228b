// Who was right: every solver's answers against the best of all.
#pragma once

#include <limits>
#include <vector>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {

/// Over one set of problems.
struct Verdict {
  int problems = 0;
  int failures = 0;        ///< the solver itself said that it failed, or returned no numbers
  int wrong = 0;           ///< said it succeeded, but the gap is above `allowed_gap`
  double worst_gap = 0.0;  ///< (objective - best objective) / || b ||^2, where it succeeded
  double worst_kkt = 0.0;  ///< of the answers that are not wrong: reference::kkt_residual
  [[nodiscard]] bool correct() const { return failures == 0 && wrong == 0; }
};

/// Of the right-hand side's norm squared: what may lie between an objective and the best of all.
inline constexpr double allowed_gap = 1e-9;

/// One solver's answer to one problem.
struct Answer {
  bool succeeded = false;
  double objective = std::numeric_limits<double>::infinity();
  Eigen::VectorXd m;
};

/// Negative masses are clipped before they are judged: an answer outside m >= 0 gets no credit.
[[nodiscard]] Answer answer(const DenseProblem& problem, bool succeeded, const Eigen::VectorXd& m);

/// One verdict for each solver, from its answers to all the problems.
[[nodiscard]] std::vector<Verdict> compare(const std::vector<std::vector<Answer>>& answers,
                                           const std::vector<DenseProblem>& problems);

/// One verdict for each peer, in their order.
[[nodiscard]] std::vector<Verdict> judge(const std::vector<PeerKind>& peers,
                                         const std::vector<DenseProblem>& problems);

}  // namespace shapeid::bench
