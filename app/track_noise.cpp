#include "shapeid/app/track_noise.hpp"

#include <algorithm>
#include <vector>

namespace shapeid::app {
namespace {

// Of the median, in variance: five times the usual error.
constexpr double outstanding_window = 25.0;

double median(const std::deque<double>& values) {
  std::vector<double> sorted(values.begin(), values.end());
  // The lower one of two: of a bad window and a good one the good one is believed.
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

void TrackNoise::learn(double variance) {
  variances_.push_back(variance);
  if (variances_.size() > most_) variances_.pop_front();
  const double limit = outstanding_window * median(variances_);
  double sum = 0.0;
  for (const double v : variances_) sum += std::min(v, limit);
  usual_ = sum / static_cast<double>(variances_.size());
  last_ = variance > limit ? variance : usual_;
}

void TrackNoise::suppose(double variance) {
  if (variances_.empty()) usual_ = variance;
  last_ = usual_;
}

}  // namespace shapeid::app
