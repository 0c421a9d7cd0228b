// How noisy the rows of windows are, when now and then a window is far off.
#pragma once

#include <cstddef>
#include <deque>

namespace shapeid::app {

/// The variance of a row over the last windows: their mean, where a window far above the median
/// counts no more than the limit between the two. So nothing that lasts less than half of them
/// (torques out of scale, an impact) decides what the others are worth.
class TrackNoise {
 public:
  /// Of so many windows, at least one.
  explicit TrackNoise(std::size_t most) : most_(most) {}

  /// The variance that least squares leaves of a row of the next window, >= 0.
  void learn(double variance);
  /// The next window says nothing of noise: it is as noisy as usual, or so much as long as nothing
  /// was learned.
  void suppose(double variance);

  [[nodiscard]] double usual() const { return usual_; }
  /// Of the last window: as usual, or its own where it stands out.
  [[nodiscard]] double last() const { return last_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("variances", variances_);
    archive("usual", usual_);
    archive("last", last_);
  }

 private:
  std::size_t most_;
  std::deque<double> variances_;
  double usual_ = 0.0, last_ = 0.0;
};

}  // namespace shapeid::app
