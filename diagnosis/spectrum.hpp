// How strong a signal with gaps is at each frequency.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

/// Power of y, whose values that do not count are zero, at whole periods in its duration.
struct Spectrum {
  double step = 0.0;          ///< Hz; the first frequency, and from each to the next
  double every = 1.0;         ///< how many periods more the next one has
  std::vector<double> power;  ///< of unit variance in y: one on average

  /// Which frequency is the last that is no larger, or the first; at most as many as there are.
  [[nodiscard]] std::size_t at(double frequency) const;
  /// Of the power at frequencies `from` to `to`, of which there must be some.
  [[nodiscard]] double mean(std::size_t from, std::size_t to) const;
};

/// Of values at these times (s), up to a frequency in Hz.
[[nodiscard]] Spectrum spectrum(const std::vector<double>& time, const Eigen::VectorXd& y,
                                double highest);

/// Of a recording at the samples of a series, s.
[[nodiscard]] std::vector<double> times(const Recording& recording, const Series& series);

/// s: the usual step from each time to the next, whatever gaps there are. Of two times at least.
[[nodiscard]] double usual_step(const std::vector<double>& time);

}  // namespace shapeid::diagnosis
