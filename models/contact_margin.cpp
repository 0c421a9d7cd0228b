#include "shapeid/models/contact_margin.hpp"

#include <algorithm>
#include <utility>

namespace shapeid {

// In periods of the cutoff. What one pass makes of an event comes after it; before, only a flag
// that is late matters.
Margin margin_of(Smoothing smoothing, double cutoff) {
  constexpr double half = 0.5, after_one_pass = 0.8;
  return {half / cutoff, (smoothing == Smoothing::causal ? after_one_pass : half) / cutoff};
}

void ContactMargin::push(FlaggedSample sample) {
  if (sample.starts_segment) finish();
  const double newest = sample.sample.time;
  near_.push_back(std::move(sample));
  while (decided_ < near_.size() &&
         newest >= near_[decided_].sample.time + margin_.before - time_rounding)
    decide();
}

void ContactMargin::finish() {
  while (decided_ < near_.size()) decide();
  near_.clear();
  decided_ = 0;
}

/// The next sample: all changes that it may be near are in near_.
void ContactMargin::decide() {
  const double time = near_[decided_].sample.time;
  while (near_.front().sample.time < time - margin_.after - time_rounding) {
    near_.pop_front();
    --decided_;
  }
  FlaggedSample& here = near_[decided_++];
  const std::vector<int>& flags = here.contacts;
  std::vector<bool> touches(flags.size(), false);
  bool wanted = std::find(flags.begin(), flags.end(), -1) == flags.end();
  for (const FlaggedSample& other : near_) {
    if (other.sample.time > time + margin_.before + time_rounding) break;
    if (change_ == ContactChange::drop && other.contacts != flags) wanted = false;
    for (std::size_t c = 0; c < flags.size(); ++c) {
      if (other.contacts[c] != 0) touches[c] = true;
    }
  }
  if (!wanted) {
    ++dropped_;
    return;
  }
  here.sample.in_contact = std::move(touches);
  ready_.push_back(here.sample);
}

std::optional<Sample> ContactMargin::next() {
  if (ready_.empty()) return std::nullopt;
  Sample sample = std::move(ready_.front());
  ready_.pop_front();
  return sample;
}

}  // namespace shapeid
