// Claim C9. The same filter over every channel of a segment without gaps, in fixed memory.
#pragma once

#include <Eigen/Core>

#include <deque>
#include <optional>

#include "shapeid/models/butterworth.hpp"

namespace shapeid {

enum class Smoothing {
  none,        ///< values as logged
  zero_phase,  ///< Butterworth forward and backward, for logs
  causal       ///< Butterworth forward only, for streams
};

/// Takes the rows of one segment on a regular grid and gives back as many filtered ones, however
/// long the segment is. Forward and backward filtering starts in the steady state, on the segment
/// continued by point reflection at both ends. The backward pass runs over blocks that begin so far
/// in the future that their start has decayed below rounding: the result is that of the whole
/// segment at once.
class SegmentFilter {
 public:
  /// `channels`: length of the rows.
  SegmentFilter(Smoothing smoothing, const Butterworth& design, Eigen::Index channels);

  /// Rows that come out near a segment's beginning (and its end, for zero_phase) in which more than
  /// a thousandth of the filter's start is left.
  [[nodiscard]] Eigen::Index unsettled() const;

  void push(const Eigen::VectorXd& row);
  /// No more rows in this segment. A segment not longer than unsettled() is lost as a whole.
  void finish();
  /// The next filtered row, if it is known already.
  [[nodiscard]] std::optional<Eigen::VectorXd> next();
  /// Forgets everything, ready for the next segment.
  void reset();

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("forward", forward_);
    archive("backward", backward_);
    archive("started", started_);
    archive("raw", raw_);
    archive("half", half_);
    archive("done", done_);
  }

 private:
  void start();
  void forward(const Eigen::VectorXd& row);
  void backward(std::size_t keep);

  Smoothing smoothing_;
  FilterState forward_, backward_;
  Eigen::Index reflected_;  ///< rows by which a segment is continued at its ends
  std::size_t decay_;       ///< rows after which a start is below rounding
  bool started_ = false;
  std::deque<Eigen::VectorXd> raw_;   ///< the first or the last reflected_ + 1 rows
  std::deque<Eigen::VectorXd> half_;  ///< rows filtered forward only
  std::deque<Eigen::VectorXd> done_;
};

}  // namespace shapeid
