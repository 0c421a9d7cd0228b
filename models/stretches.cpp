#include "shapeid/models/stretches.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

namespace shapeid {
namespace {

/// Digests that are counted.
constexpr std::size_t most_kept = 1U << 12U;

/// The next state of splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t state) {
  state += 0x9E3779B97F4A7C15;
  state = (state ^ (state >> 30U)) * 0xBF58476D1CE4E5B9;
  state = (state ^ (state >> 27U)) * 0x94D049BB133111EB;
  return state ^ (state >> 31U);
}

}  // namespace

void RowDigest::add(double value) {
  const std::uint64_t bits =
      std::isnan(value) ? 1 : (value == 0.0 ? 0 : std::bit_cast<std::uint64_t>(value));
  state_ = mixed(state_ ^ bits);
}

void Stretch::add(std::uint64_t row) { rows_[count_++ % length] = row; }

std::optional<std::uint64_t> Stretch::digest() const {
  if (count_ < length) return std::nullopt;
  std::uint64_t state = 0;
  for (std::size_t k = 0; k < length; ++k) state = mixed(state ^ rows_[(count_ + k) % length]);
  return state;
}

bool Stretch::moves() const {
  std::array<std::uint64_t, length> sorted = rows_;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

void StretchCounts::add(std::uint64_t digest) {
  ++times_[digest];
  if (times_.size() > most_kept) times_.erase(std::prev(times_.end()));
}

std::uint64_t StretchCounts::limit() const {
  return times_.size() < most_kept ? std::numeric_limits<std::uint64_t>::max()
                                   : times_.rbegin()->first;
}

void RepeatedStretches::add(const MeasuredRow& row) {
  RowDigest digest;
  for (const int first : {plan_.q, plan_.tau}) {
    for (const double value : row.values.segment(first, joints_)) digest.add(value);
  }
  stretch_.add(digest.value());
  const std::optional<std::uint64_t> state = stretch_.digest();
  if (!state || !stretch_.moves()) return;
  counts_.add(*state);
}

double RepeatedStretches::share() const {
  std::size_t all = 0;
  for (const auto& [state, times] : counts_.times()) all += times;
  if (all == 0) return 0.0;
  return static_cast<double>(all - counts_.times().size()) / static_cast<double>(all);
}

}  // namespace shapeid
