// Two scales weigh one point mass: exits 0 if the installed checker accepts the mean of what they
// read, and nothing else.
#include <shapeid/proofs/certificate/certificate_json.hpp>
#include <shapeid/proofs/certificate/certify.hpp>

#include <string>

namespace {

namespace certificate = shapeid::certificate;

bool accepted(const shapeid::StatedProblem& problem, double mass) {
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(10);
  parameters[0] = mass;
  const double objective = (mass - 1.0) * (mass - 1.0) + (mass - 3.0) * (mass - 3.0);
  const shapeid::Answer answer{shapeid::problem_digest(problem),
                               Eigen::VectorXd::Constant(1, mass),
                               parameters,
                               objective,
                               {}};
  const certificate::Certified judged = certificate::certify(problem, answer);
  const std::string file = certificate::certificate_to_json(judged.proof, {});
  const auto read = certificate::certificate_from_json(file, "certificate.json", problem);
  return judged.reasons.empty() && certificate::false_claims(read, judged.proof).empty();
}

}  // namespace

int main() {
  shapeid::StatedProblem problem;
  shapeid::MassProblem& p = problem.masses;
  p.Y = Eigen::MatrixXd::Zero(2, 10);
  p.Y.col(0).setOnes();
  p.U = Eigen::VectorXd::Unit(10, 0);
  p.F = Eigen::Vector2d(1.0, 3.0);
  p.W = Eigen::Vector2d::Ones();
  p.V = Eigen::VectorXd::Ones(1);
  return accepted(problem, 2.0) && !accepted(problem, 1.5) ? 0 : 1;
}
