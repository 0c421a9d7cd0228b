#include "shapeid/fast/parameter_tracker.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <limits>
#include <string>

namespace shapeid::fast {
namespace {

/// Squares of rows up to this size add up over any log without overflow, as in SampleRows: a row
/// that is no number would stay in the triangle for ever.
constexpr double largest_square = 1e290;

/// A NaN is not below either.
bool can_be_absorbed(const Eigen::MatrixXd& rows) { return rows.squaredNorm() < largest_square; }

/// Whether rows with these variances are numbers that Triangle does not leave out: no pivot's
/// square is below the inverse of its variance.
bool have_rows(const Eigen::VectorXd& variances) {
  return (variances.array() < largest_square).all() &&
         (variances.array() > 1.0 / largest_square).all();
}

}  // namespace

Violation why_no_belief(const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                        const Eigen::VectorXd& wander) {
  if (spread.size() != start.size() || wander.size() != start.size()) {
    return "a mean of " + std::to_string(start.size()) + " parameters, a spread of " +
           std::to_string(spread.size()) + ", a wander of " + std::to_string(wander.size());
  }
  if (!start.allFinite()) return "a mean is not finite";
  if (!(spread.array() > 0.0).all() || !have_rows(spread.cwiseAbs2())) {
    return "a spread is not positive and finite, or its square is not";
  }
  if (!can_be_absorbed(start.cwiseQuotient(spread))) {
    return "a mean is too many spreads from zero";
  }
  if (!wander.allFinite() || !(wander.array() >= 0.0).all())
    return "a wander is negative or not finite";
  return std::nullopt;
}

Violation why_no_time(double seconds) {
  if (seconds >= 0.0 && std::isfinite(seconds)) return std::nullopt;
  return "a time of " + std::to_string(seconds) + " s";
}

Violation why_no_variance(double variance) {
  if (variance > 0.0 && std::isfinite(variance)) return std::nullopt;
  return "a variance of " + std::to_string(variance);
}

ParameterTracker::ParameterTracker(const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                                   const Eigen::VectorXd& wander)
    : spread_(spread), wander_(wander), rows_(start.size()) {
  SHAPEID_CONTRACT(why_no_belief(start, spread, wander));
  // Without rows every answer would be no number, in silence.
  if (!set(start, spread.cwiseAbs2().asDiagonal())) {
    throw Defect("parameters are believed in that no rows can say");
  }
}

bool ParameterTracker::set(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance) {
  if (!have_rows(covariance.diagonal())) return false;
  // In units of the spread, where entries are of one size; P = L L^T gives the rows L^-1 x = L^-1
  // x0.
  const Eigen::VectorXd unit = spread_.cwiseInverse();
  const Eigen::MatrixXd P = unit.asDiagonal() * covariance * unit.asDiagonal();
  if (!P.allFinite()) return false;  // its rows would be zero, or no numbers
  Eigen::LLT<Eigen::MatrixXd> llt(P);
  if (llt.info() != Eigen::Success) {
    // What is known to more digits than a double has beside the rest is known to as many.
    const double rounding =
        static_cast<double>(P.rows()) * std::numeric_limits<double>::epsilon() * P.trace();
    llt.compute(P + rounding * Eigen::MatrixXd::Identity(P.rows(), P.cols()));
    if (llt.info() != Eigen::Success) return false;
  }
  Eigen::MatrixXd rows(mean.size(), mean.size() + 1);
  rows.leftCols(mean.size()) = unit.asDiagonal();
  rows.col(mean.size()) = unit.cwiseProduct(mean);
  llt.matrixL().solveInPlace(rows);
  if (!can_be_absorbed(rows)) return false;
  rows_.clear();
  rows_.absorb(rows);
  return true;
}

bool ParameterTracker::drift(double seconds) {
  SHAPEID_CONTRACT(why_no_time(seconds));
  Eigen::MatrixXd P = covariance();
  P.diagonal() += seconds * wander_.cwiseAbs2();
  return set(mean(), P);
}

bool ParameterTracker::measure(const Triangle& window, double variance) {
  SHAPEID_CONTRACT(why_no_variance(variance));
  Eigen::MatrixXd rows = window.R() / std::sqrt(variance);
  if (!can_be_absorbed(rows)) return false;
  rows_.absorb(rows);
  return true;
}

bool ParameterTracker::loosen() {
  Eigen::MatrixXd P = covariance();
  P.diagonal() += spread_.cwiseAbs2();
  return set(mean(), P);
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
