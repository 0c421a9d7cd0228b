#include "shapeid/tests/bench/peers/verdict.hpp"

#include <algorithm>
#include <limits>

#include "shapeid/reference/mass_solver.hpp"

namespace shapeid::bench {
namespace {

struct Answer {
  bool succeeded = false;
  double objective = std::numeric_limits<double>::infinity();
  Eigen::VectorXd m;
};

std::vector<Answer> answers_of(const PeerKind& kind, const std::vector<DenseProblem>& problems) {
  const std::unique_ptr<MassPeer> peer = kind.make();
  std::vector<Answer> answers;
  Prepared prepared;
  Eigen::VectorXd m, start;
  for (const DenseProblem& problem : problems) {
    prepare(problem, Form::normal, prepared);
    const bool warm = kind.warm && problem.follows && m.size() > 0;
    if (warm) carry_over(problem, m, start);
    Answer answer;
    answer.succeeded = peer->solve(problem, prepared, warm ? &start : nullptr, m) && m.allFinite();
    if (answer.succeeded) {
      answer.m = m.cwiseMax(0.0);
      answer.objective = objective(problem.triangle, answer.m).total();
    } else {
      m.resize(0);  // no warm start from a failure
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

}  // namespace

std::vector<Verdict> judge(const std::vector<PeerKind>& peers,
                           const std::vector<DenseProblem>& problems) {
  std::vector<std::vector<Answer>> all;
  for (const PeerKind& kind : peers) all.push_back(answers_of(kind, problems));

  std::vector<Verdict> verdicts(peers.size());
  for (std::size_t i = 0; i < problems.size(); ++i) {
    double best = std::numeric_limits<double>::infinity();
    for (const auto& answers : all) best = std::min(best, answers[i].objective);
    const MassProblem& problem = problems[i].triangle;
    for (std::size_t p = 0; p < peers.size(); ++p) {
      const Answer& answer = all[p][i];
      Verdict& verdict = verdicts[p];
      ++verdict.problems;
      if (!answer.succeeded) {
        ++verdict.failures;
        continue;
      }
      const double gap = (answer.objective - best) / problem.F.squaredNorm();
      verdict.worst_gap = std::max(verdict.worst_gap, gap);
      if (gap > allowed_gap) {
        ++verdict.wrong;
      } else {
        verdict.worst_kkt =
            std::max(verdict.worst_kkt, reference::kkt_residual(problem, answer.m).worst());
      }
    }
  }
  return verdicts;
}

}  // namespace shapeid::bench
