#include "shapeid/tests/certificate/verdict.hpp"

#include "shapeid/models/error.hpp"

namespace shapeid::test {

using namespace certificate;

Files honest_files(const StatedProblem& problem, const Answer& answer, bool floor) {
  const Guess guess{answer.parameters, answer.others};
  const Evidence evidence = floor ? Evidence{guess, guess, guess} : Evidence{};
  return {problem_to_json(problem), answer_to_json(answer),
          certificate_to_json(certify(problem, answer, {}, evidence).proof, evidence)};
}

std::vector<std::string> refusals(const Files& files) {
  const StatedProblem problem = stated_problem_from_json(files.problem, "problem.json");
  const Answer answer = answer_from_json(files.answer, "answer.json");
  if (const Violation why = why_unfit(problem, answer)) return {*why};
  if (files.certificate.empty()) return certify(problem, answer).reasons;
  const Certificate given = certificate_from_json(files.certificate, "certificate.json", problem);
  const Certified certified = certify(problem, answer, {}, given.evidence);
  std::vector<std::string> reasons = false_claims(given, certified.proof);
  reasons.insert(reasons.begin(), certified.reasons.begin(), certified.reasons.end());
  return reasons;
}

bool accepted(const Files& files) {
  try {
    return refusals(files).empty();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace shapeid::test
