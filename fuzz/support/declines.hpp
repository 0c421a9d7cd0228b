// How often the fast path was asked, and declined: each decline may be right, but most must not be.
#pragma once

#include <cstdint>

namespace shapeid::fuzz {

/// Over all inputs of a run. A target counts only inputs that a robot could make; driver/replay.cpp
/// reads it at the end, where libFuzzer has no end to read it at.
struct Declines {
  std::uint64_t asked = 0, declined = 0;

  void count(bool has_declined) {
    ++asked;
    if (has_declined) ++declined;
  }

  /// Whether more than a tenth of a few dozen were declined. Bytes spell problems worse than any
  /// robot's, of which some may be (none of 651 inputs is); a path that always declines keeps every
  /// other promise.
  [[nodiscard]] bool too_many() const {
    constexpr std::uint64_t enough = 24;
    return asked >= enough && 10 * declined > asked;
  }
};

inline Declines declines;

}  // namespace shapeid::fuzz
