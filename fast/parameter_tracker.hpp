// Parameters that may wander, from the rows of one window after the other: a Kalman filter in
// square-root information form. What filter (17) is not: it weighs windows by what they say, and it
// has a covariance.
#pragma once

#include <Eigen/Core>

#include "shapeid/fast/triangle.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {

/// What the tracker asks of its caller: as many numbers each, finite; spread > 0, its square a
/// number above zero too, and start / spread one; wander >= 0.
[[nodiscard]] Violation why_no_belief(const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                                      const Eigen::VectorXd& wander);
/// Empty for a time >= 0, s.
[[nodiscard]] Violation why_no_time(double seconds);
/// Empty for a variance > 0.
[[nodiscard]] Violation why_no_variance(double variance);

/// x(t + dt) = x(t) + w, w ~ N(0, dt diag(wander^2));  R x = c + noise of one variance: each window
/// is a triangle [R c]. (docs/tracking.md)
class ParameterTracker {
 public:
  /// `start`: what is believed at first, with standard deviations `spread` (> 0); `wander` (>= 0):
  /// standard deviations after one second without data. As many numbers each as there are unknowns.
  /// Throws Defect where why_no_belief() has a reason that leaves nothing to start from.
  ParameterTracker(const Eigen::VectorXd& start, const Eigen::VectorXd& spread,
                   const Eigen::VectorXd& wander);

  // Each of the three says whether it came about. Where numbers are not finite, or what would come
  // of them is not, the belief stays as it was.

  /// Time goes by, s (>= 0): every parameter is known a little less well.
  [[nodiscard]] bool drift(double seconds);
  /// The rows of a window, each with noise of this variance (> 0).
  [[nodiscard]] bool measure(const Triangle& window, double variance);
  /// Something has changed that is no wandering: the mean stays, the covariance grows by spread^2.
  [[nodiscard]] bool loosen();

  /// [R c] with R^T R the inverse covariance, in the parameters' units: the rows that a mass
  /// problem can be solved on.
  [[nodiscard]] const Triangle& rows() const { return rows_; }
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("rows", rows_);
  }

 private:
  /// Rows that say: this mean, this covariance. False if none do: then the old ones stay.
  [[nodiscard]] bool set(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance);

  Eigen::VectorXd spread_, wander_;
  Triangle rows_;
};

}  // namespace shapeid::fast
