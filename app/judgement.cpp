#include "shapeid/app/judgement.hpp"

#include "shapeid/app/limit.hpp"

namespace shapeid::app {

Judgement judge(const Result& result) {
  const MassSolution& solution = result.found.run.solution;
  Judgement judged{stated_problem(result), {}, {}, {}};
  judged.answer = {
      problem_digest(judged.problem), solution.m, solution.Phi, solution.value.total(), {}};
  judged.evidence = limit_of_divisions(judged.problem);
  judged.certified = certificate::certify(judged.problem, judged.answer, {}, judged.evidence);
  return judged;
}

}  // namespace shapeid::app
