// What becomes of samples near a change of contact, where a filter mixes both sides.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "shapeid/models/motion.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid {

/// s: how long a contact counts is often a whole number of steps, and times are rounded, most of
/// all those of a clock that began in 1970. Which flags a sample gets must not depend on when the
/// log was begun.
inline constexpr double time_rounding = 1e-6;

/// How long before and after a change of contact samples are near it, s.
struct Margin {
  double before = 0.0, after = 0.0;
};

/// Where none is given, of a filter of second order (docs/derivations/filtering.md).
[[nodiscard]] Margin margin_of(Smoothing smoothing, double cutoff);

/// A sample with its contact flags still as numbers: 1, 0, or -1 for not known.
struct FlaggedSample {
  Sample sample;
  std::vector<int> contacts;
  bool starts_segment = false;  ///< the first one after a gap

  template <class Archive>
  void state(Archive& archive) {
    archive("sample", sample);
    archive("contacts", contacts);
    archive("starts_segment", starts_segment);
  }
};

/// Holds samples back until the contacts are known to which they may be near. A contact that is
/// not known may touch: its samples are dropped, and it counts as touching for those near it.
class ContactMargin {
 public:
  /// Of no width it only drops samples whose contacts are not known.
  ContactMargin(ContactChange change, Margin margin) : change_(change), margin_(margin) {}

  /// Nothing counts across the start of a segment.
  void push(FlaggedSample sample);
  /// No more samples will come.
  void finish();
  [[nodiscard]] std::optional<Sample> next();
  [[nodiscard]] std::size_t dropped() const { return dropped_; }
  /// Those since the last call, which are then no longer counted.
  [[nodiscard]] std::size_t take_dropped() { return std::exchange(dropped_, 0); }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("near", near_);
    archive("decided", decided_);
    archive("ready", ready_);
    archive("dropped", dropped_);
  }

 private:
  void decide();

  ContactChange change_;
  Margin margin_;
  std::deque<FlaggedSample> near_;  ///< all that the next to decide depends on
  std::size_t decided_ = 0;         ///< of these, from the front
  std::deque<Sample> ready_;
  std::size_t dropped_ = 0;
};

}  // namespace shapeid
