#include "shapeid/models/segment_filter.hpp"

#include <limits>
#include <utility>

namespace shapeid {
namespace {

// What may be left of the filter's start in a row that is handed on: the reflection at a segment's
// end turns the acceleration's sign, and a thousandth of that is below any real noise.
constexpr double settled_fraction = 1e-3;
// Below the rounding of the filtered values themselves.
constexpr double rounding_fraction = std::numeric_limits<double>::epsilon() / 4.0;

}  // namespace

SegmentFilter::SegmentFilter(Smoothing smoothing, const Butterworth& design, Eigen::Index channels)
    : smoothing_(smoothing),
      forward_(design, channels),
      backward_(design, channels),
      reflected_(smoothing == Smoothing::none ? 0 : design.samples_to_decay(settled_fraction)),
      decay_(static_cast<std::size_t>(design.samples_to_decay(rounding_fraction))) {}

Eigen::Index SegmentFilter::unsettled() const { return reflected_; }

void SegmentFilter::reset() {
  started_ = false;
  raw_.clear();
  half_.clear();
  done_.clear();
}

void SegmentFilter::push(const Eigen::VectorXd& row) {
  if (smoothing_ == Smoothing::none) {
    done_.push_back(row);
    return;
  }
  raw_.push_back(row);
  if (started_) {
    raw_.pop_front();
    forward(row);
  } else if (std::cmp_equal(raw_.size(), reflected_ + 1)) {
    start();
  }
  if (smoothing_ == Smoothing::zero_phase && half_.size() >= 3 * decay_) backward(decay_);
}

/// Settles on the segment's beginning, reflected in its first row.
void SegmentFilter::start() {
  started_ = true;
  const Eigen::VectorXd& pivot = raw_.front();
  forward_.settle(2.0 * pivot - raw_.back());
  for (std::size_t k = raw_.size() - 1; k > 0; --k) {
    static_cast<void>(forward_.step(2.0 * pivot - raw_[k]));
  }
  for (const Eigen::VectorXd& row : raw_) forward(row);
}

void SegmentFilter::forward(const Eigen::VectorXd& row) {
  (smoothing_ == Smoothing::causal ? done_ : half_).push_back(forward_.step(row));
}

/// Filters half_ backward and hands on all but the last `keep` rows, which only served to start.
void SegmentFilter::backward(std::size_t keep) {
  backward_.settle(half_.back());
  const std::size_t ready = half_.size() - keep;
  std::deque<Eigen::VectorXd> filtered;
  for (std::size_t k = half_.size(); k > 0; --k) {
    Eigen::VectorXd row = backward_.step(half_[k - 1]);
    if (k <= ready) filtered.push_front(std::move(row));
  }
  for (Eigen::VectorXd& row : filtered) done_.push_back(std::move(row));
  half_.erase(half_.begin(), half_.begin() + static_cast<std::ptrdiff_t>(ready));
}

void SegmentFilter::finish() {
  if (smoothing_ != Smoothing::zero_phase || !started_) return;
  const Eigen::VectorXd pivot = raw_.back();
  for (std::size_t k = raw_.size() - 1; k > 0; --k) forward(2.0 * pivot - raw_[k - 1]);
  backward(raw_.size() - 1);
}

std::optional<Eigen::VectorXd> SegmentFilter::next() {
  if (done_.empty()) return std::nullopt;
  Eigen::VectorXd row = std::move(done_.front());
  done_.pop_front();
  return row;
}

}  // namespace shapeid
