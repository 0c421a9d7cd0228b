// certificate.json: read for a problem, and held against what is proved of an answer.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"

using namespace shapeid;

namespace {

/// Two cuboids of one link, of which the second explains the two rows best without mass.
StatedProblem small_problem() {
  StatedProblem stated;
  MassProblem& p = stated.masses;
  p.Y = Eigen::MatrixXd::Zero(2, 10);
  p.Y.diagonal().setOnes();
  p.U = Eigen::MatrixXd::Zero(10, 2);
  p.U.topRows<2>() << 1.0, 1.0, 0.25, -0.25;
  p.F = Eigen::Vector2d(2.0, 0.75);
  p.W = Eigen::Vector2d(1.0, 2.0);
  p.V = Eigen::Vector2d(0.5, 0.25);
  p.lambda = 1e-6;
  p.mass_bound = 10.0;
  return stated;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const StatedProblem problem = small_problem();
  static const certificate::Proof proof = [] {
    const Eigen::VectorXd m = Eigen::Vector2d(2.0, 0.0);
    const Answer answer{problem_digest(problem), m, problem.masses.U * m,
                        objective(problem.masses, m).total()};
    return certificate::certify(problem, answer).proof;
  }();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto given =
      fuzz::accepted([&] { return certificate::certificate_from_json(text, "c.json", problem); });
  if (!given) return 0;
  const auto& evidence = given->evidence;
  for (const auto& guess : {evidence.limit, evidence.bodies, evidence.masses}) {
    fuzz::check(guess.parameters.allFinite() && guess.others.allFinite(), "evidence is finite");
  }
  if (!certificate::false_claims(*given, proof).empty()) return 0;
  // A certificate with no false claim is the one that we write, with its evidence.
  const std::string written = certificate::certificate_to_json(proof, evidence);
  const certificate::Certificate again =
      certificate::certificate_from_json(written, "w.json", problem);
  fuzz::check(again.claim == given->claim, "a true certificate reads back the same");
  return 0;
}
