#include "shapeid/models/row_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace shapeid {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
// Share of the channel's largest magnitude below which nothing is an outlier. When feet hit the
// ground, joint velocities of a trot jump by 12 percent of it within three rows, positions by 0.3.
constexpr double harmless = 0.3;
// What was an outlier may be the first of a new kind of motion: each makes the channel this much
// less strict, so that a handful is left out, and not all that follows.
constexpr double learns = 1.2;
// Rows in which strictness comes back by 1 / e. Many strides.
constexpr double memory = 5000.0;
// A run of equal values is a fault when it is this many times as long as the longest natural one.
constexpr std::size_t unnatural = 4;
// Instead of a kind.
constexpr int not_judged = -1;

/// Channels of one kind, which stand still together when the robot does: number of the first
/// channel, and how many.
struct Kind {
  int first;
  std::size_t size;
};

std::vector<Kind> kinds(const ChannelPlan& plan, std::size_t joints) {
  std::vector<int> firsts;
  for (const int first : {plan.gyro, plan.accel, plan.q, plan.tau}) {
    if (first >= 0) firsts.push_back(first);
  }
  std::vector<Kind> result;
  for (const int first : firsts) {
    const bool imu = first == plan.gyro || first == plan.accel;
    result.push_back({first, imu ? 3 : joints});
  }
  return result;
}

}  // namespace

RowGuard::RowGuard(const ChannelPlan& plan, std::size_t joints)
    : kind_(plan.channels.size(), not_judged) {
  const std::vector<Kind> all = kinds(plan, joints);
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t i = 0; i < all[k].size; ++i) {
      const std::size_t channel = static_cast<std::size_t>(all[k].first) + i;
      // A held channel repeats itself by nature: it is left to the resampler.
      if (plan.channels[channel].hold_group < 0) kind_[channel] = static_cast<int>(k);
    }
  }
  const auto n = static_cast<Eigen::Index>(kind_.size());
  ordinary_ = largest_ = Eigen::VectorXd::Zero(n);
  last_ = Eigen::VectorXd::Constant(n, nothing);
  run_.assign(kind_.size(), 0);
  natural_run_.assign(kind_.size(), 0);
}

void RowGuard::push(MeasuredRow row) {
  ++seen_;
  held_.push_back({std::move(row), {}});
  watch_runs();
  while (judged_ + half < held_.size()) judge_outliers(judged_++);
  if (held_.size() > reach) hand_on();
}

void RowGuard::flush() {
  while (!held_.empty()) hand_on();
  std::fill(run_.begin(), run_.end(), 0);
  last_.setConstant(nothing);
}

void RowGuard::hand_on() {
  done_.push_back(std::move(held_.front()));
  held_.pop_front();
  if (judged_ > 0) --judged_;
}

std::optional<GuardedRow> RowGuard::next() {
  if (done_.empty()) return std::nullopt;
  GuardedRow row = std::move(done_.front());
  done_.pop_front();
  return row;
}

/// Most of the other channels of its kind change in the newest row.
bool RowGuard::others_go_on(std::size_t channel) const {
  int others = 0, changing = 0;
  for (std::size_t c = 0; c < kind_.size(); ++c) {
    if (c == channel || kind_[c] != kind_[channel]) continue;
    ++others;
    if (run_[c] == 0) ++changing;
  }
  return 2 * changing > others;
}

void RowGuard::watch_runs() {
  const Eigen::VectorXd values = held_.back().row.values;
  for (std::size_t c = 0; c < kind_.size(); ++c) {
    const double value = values[static_cast<Eigen::Index>(c)];
    double& last = last_[static_cast<Eigen::Index>(c)];
    if (kind_[c] == not_judged || std::isnan(value)) continue;
    run_[c] = value == last && value != 0.0 ? run_[c] + 1 : 0;
    last = value;
    if (seen_ <= learning) natural_run_[c] = std::max(natural_run_[c], run_[c]);
  }
  if (seen_ <= learning) return;
  for (std::size_t c = 0; c < kind_.size(); ++c) {
    if (kind_[c] != not_judged && run_[c] >= std::max(reach - 1, unnatural * natural_run_[c]) &&
        others_go_on(c)) {
      take_out_run(static_cast<int>(c));
    }
  }
}

/// All rows that are held and repeat the channel's last value.
void RowGuard::take_out_run(int channel) {
  const double value = last_[channel];
  const bool at_the_end = std::abs(value) >= largest_[channel];
  for (GuardedRow& held : held_) {
    if (held.row.values[channel] != value) continue;
    held.row.values[channel] = nothing;
    (at_the_end ? held.faults.saturated : held.faults.stuck).push_back(channel);
  }
}

/// Compares a row that is held with the rows around it, as far as they are there.
void RowGuard::judge_outliers(std::size_t at) {
  const std::size_t first = at - std::min(at, half);
  const std::size_t last = std::min(at + half, held_.size() - 1);
  for (std::size_t c = 0; c < kind_.size(); ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    double& value = held_[at].row.values[i];
    if (kind_[c] == not_judged || std::isnan(value)) continue;
    std::array<double, 2 * half + 1> around{};
    std::size_t count = 0;
    for (std::size_t k = first; k <= last; ++k) {
      const double other = held_[k].row.values[i];
      if (!std::isnan(other)) around[count++] = other;
    }
    auto* const middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
    const double distance = std::abs(value - *middle);
    const double most = std::max(far * ordinary_[i], harmless * largest_[i]);
    ordinary_[i] *= 1.0 - 1.0 / memory;
    if (seen_ > learning && distance > most) {
      value = nothing;
      held_[at].faults.outliers.push_back(static_cast<int>(c));
      ordinary_[i] *= learns;
      largest_[i] *= learns;
    } else {
      ordinary_[i] = std::max(ordinary_[i], distance);
      largest_[i] = std::max(largest_[i], std::abs(value));
    }
  }
}

}  // namespace shapeid
