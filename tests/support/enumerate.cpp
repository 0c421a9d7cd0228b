#include "shapeid/tests/support/enumerate.hpp"

#include <Eigen/QR>

namespace shapeid::test {

Eigen::VectorXd best_of_all_active_sets(const MassProblem& p) {
  const Eigen::Index n = p.shapes(), rows = p.F.size();
  // || A m - b ||^2 + || D m ||^2 as one least squares with the rows of D under those of A.
  const Eigen::VectorXd root = p.W.cwiseSqrt();
  Eigen::MatrixXd A(rows + n, n);
  A << root.asDiagonal() * p.Y * p.U, Eigen::MatrixXd::Zero(n, n);
  A.bottomRows(n).diagonal() = (p.lambda * p.V.cwiseInverse()).cwiseSqrt();
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows + n);
  b.head(rows) = root.cwiseProduct(p.F);
  // Unit columns: the rank of a set is then decided by angles, not by units.
  const Eigen::VectorXd norms =
      A.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());

  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double lowest = objective(p, best).total();
  for (unsigned set = 1; set < (1U << static_cast<unsigned>(n)); ++set) {
    std::vector<Eigen::Index> passive;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (set >> static_cast<unsigned>(j) & 1U) passive.push_back(j);
    }
    const Eigen::MatrixXd A_P = (A * norms.cwiseInverse().asDiagonal())(Eigen::all, passive);
    const Eigen::VectorXd x = A_P.completeOrthogonalDecomposition().solve(b);
    Eigen::VectorXd m = Eigen::VectorXd::Zero(n);
    m(passive) = x.cwiseQuotient(norms(passive)).cwiseMax(0.0);
    const double value = objective(p, m).total();
    if (value < lowest) {
      lowest = value;
      best = m;
    }
  }
  return best;
}

}  // namespace shapeid::test
