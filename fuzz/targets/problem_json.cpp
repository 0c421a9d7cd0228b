// problem.json: what is read is written and read back the same, and can be judged.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/proofs/certificate/certify.hpp"

using namespace shapeid;

namespace {

/// Numbers of a problem that exact arithmetic is done with soon enough.
constexpr Eigen::Index few = 400;

void judge_no_mass(const StatedProblem& problem) {
  const MassProblem& p = problem.masses;
  if (p.Y.size() + p.U.size() + problem.others.values.size() > few) return;
  const Answer none{problem_digest(problem), Eigen::VectorXd::Zero(p.shapes()),
                    Eigen::VectorXd::Zero(p.U.rows()), p.F.dot(p.W.cwiseProduct(p.F)),
                    Eigen::VectorXd::Zero(problem.others.values.cols())};
  if (certificate::why_unfit(problem, none)) return;
  const certificate::Proof proof = certificate::certify(problem, none).proof;
  fuzz::check(proof.lower >= 0.0 && proof.lower <= proof.upper, "bounds come in order");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto problem = fuzz::accepted([&] { return stated_problem_from_json(text, "p.json"); });
  if (!problem) return 0;
  fuzz::check(!why_malformed(*problem), "a problem that was read is well-formed");
  const std::string written = problem_to_json(*problem);
  const StatedProblem again = stated_problem_from_json(written, "w.json");
  const MassProblem &was = problem->masses, &is = again.masses;
  fuzz::check(is.Y == was.Y && is.F == was.F && is.W == was.W && is.U == was.U && is.V == was.V &&
                  is.lambda == was.lambda && is.mass_bound == was.mass_bound,
              "the masses' problem reads back the same");
  fuzz::check(again.shapes.size() == problem->shapes.size() &&
                  again.regions.size() == problem->regions.size(),
              "no shape and no region is lost");
  fuzz::check(problem_to_json(again) == written, "a problem is written the same again");
  judge_no_mass(*problem);
  return 0;
}
