#include "shapeid/fast/parameter_tracker.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <limits>

namespace shapeid::fast {

ParameterTracker::ParameterTracker(const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                                   const Eigen::VectorXd& wander)
    : spread_(spread), wander_(wander), rows_(start.size()) {
  set(start, spread.cwiseAbs2().asDiagonal());
}

void ParameterTracker::set(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  // In units of the spread, where entries are of one size; P = L L^T gives the rows L^-1 x = L^-1
  // x0.
  const Eigen::VectorXd unit = spread_.cwiseInverse();
  const Eigen::MatrixXd P = unit.asDiagonal() * covariance * unit.asDiagonal();
  Eigen::LLT<Eigen::MatrixXd> llt(P);
  if (llt.info() != Eigen::Success) {
    // What is known to more digits than a double has beside the rest is known to as many.
    const double rounding =
        static_cast<double>(P.rows()) * std::numeric_limits<double>::epsilon() * P.trace();
    llt.compute(P + rounding * Eigen::MatrixXd::Identity(P.rows(), P.cols()));
  }
  Eigen::MatrixXd rows(mean.size(), mean.size() + 1);
  rows.leftCols(mean.size()) = unit.asDiagonal();
  rows.col(mean.size()) = unit.cwiseProduct(mean);
  llt.matrixL().solveInPlace(rows);
  rows_.clear();
  rows_.absorb(rows);
}

void ParameterTracker::drift(double seconds) {
  Eigen::MatrixXd P = covariance();
  P.diagonal() += seconds * wander_.cwiseAbs2();
  set(mean(), P);
}

void ParameterTracker::measure(const Triangle& window, double variance) {
  Eigen::MatrixXd rows = window.R() / std::sqrt(variance);
  rows_.absorb(rows);
}

void ParameterTracker::loosen() {
  Eigen::MatrixXd P = covariance();
  P.diagonal() += spread_.cwiseAbs2();
  set(mean(), P);
}

Eigen::VectorXd ParameterTracker::mean() const {
  const Eigen::Index n = spread_.size();
  return rows_.R().topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(
      rows_.R().col(n).head(n));
}

Eigen::MatrixXd ParameterTracker::covariance() const {
  const Eigen::Index n = spread_.size();
  const Eigen::MatrixXd inverse =
      rows_.R().topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(
          Eigen::MatrixXd::Identity(n, n));
  return inverse * inverse.transpose();
}

}  // namespace shapeid::fast
