#include "shapeid/tests/bench/peers/verdict.hpp"

#include <algorithm>
#include <limits>

#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::bench {
namespace {

std::vector<Answer> answers_of(const PeerKind& kind, const std::vector<DenseProblem>& problems) {
  const std::unique_ptr<MassPeer> peer = kind.make();
  std::vector<Answer> answers;
  Prepared prepared;
  Eigen::VectorXd m, start;
  for (const DenseProblem& problem : problems) {
    prepare(problem, Form::normal, prepared);
    const bool warm = kind.warm && problem.follows && m.size() > 0;
    if (warm) carry_over(problem, m, start);
    const bool succeeded = peer->solve(problem, prepared, warm ? &start : nullptr, m);
    answers.push_back(answer(problem, succeeded, m));
    if (!answers.back().succeeded) m.resize(0);  // no warm start from a failure
  }
  return answers;
}

}  // namespace

Answer answer(const DenseProblem& problem, bool succeeded, const Eigen::VectorXd& m) {
  Answer a;
  a.succeeded = succeeded && m.allFinite();
  if (a.succeeded) {
    a.m = m.cwiseMax(0.0);
    a.objective = objective(problem.triangle, a.m).total();
  }
  return a;
}

std::vector<Verdict> compare(const std::vector<std::vector<Answer>>& answers,
                             const std::vector<DenseProblem>& problems) {
  std::vector<Verdict> verdicts(answers.size());
  for (std::size_t i = 0; i < problems.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& one : answers) best = std::min(best, one[i].objective);
    const MassProblem& problem = problems[i].triangle;
    for (std::size_t p = 0; p < answers.size(); ++p) {
      const Answer& given = answers[p][i];
      Verdict& verdict = verdicts[p];
      ++verdict.problems;
      if (!given.succeeded) {
        ++verdict.failures;
        continue;
      }
      const double gap = (given.objective - best) / problem.F.squaredNorm();
      verdict.worst_gap = std::max(verdict.worst_gap, gap);
      if (gap > allowed_gap) {
        ++verdict.wrong;
      } else {
        verdict.worst_kkt =
            std::max(verdict.worst_kkt, reference::kkt_residual(problem, given.m).worst());
      }
    }
  }
  return verdicts;
}

std::vector<Verdict> judge(const std::vector<PeerKind>& peers,
                           const std::vector<DenseProblem>& problems) {
  std::vector<std::vector<Answer>> answers;
  for (const PeerKind& kind : peers) answers.push_back(answers_of(kind, problems));
  return compare(answers, problems);
}

}  // namespace shapeid::bench
