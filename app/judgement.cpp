#include "shapeid/app/judgement.hpp"

#include "shapeid/app/limit.hpp"
#include "shapeid/app/relaxed_optima.hpp"

namespace shapeid::app {

Judgement judge(const Result& result) {
  const MassSolution& solution = result.found.run.solution;
  Judgement judged{stated_problem(result), {}, {}, {}};
  judged.answer = {
      problem_digest(judged.problem), solution.m, solution.Phi, solution.value.total(), {}};
  judged.evidence = {limit_of_divisions(judged.problem), least_over_bodies(judged.problem),
                     least_over_masses(judged.problem)};
  judged.certified = certificate::certify(judged.problem, judged.answer, {}, judged.evidence);
  return judged;
}

}  // namespace shapeid::app
