// Digests of rows that follow each other, by which measurements are known again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "shapeid/models/channels.hpp"

namespace shapeid {

/// Of numbers in their order, bit by bit; a missing one is one NaN, and a zero has no sign.
class RowDigest {
 public:
  void add(double value);
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

/// Single rows of one joint and coarse sensors coincide in any two logs, so many that follow each
/// other do not.
class Stretch {
 public:
  static constexpr std::size_t length = 10;

  /// The next row's digest.
  void add(std::uint64_t row);
  /// Of the last rows; empty before there are enough.
  [[nodiscard]] std::optional<std::uint64_t> digest() const;
  /// No two of the last rows are the same: a robot that rests may read the same at any time.
  [[nodiscard]] bool moves() const;

 private:
  std::array<std::uint64_t, length> rows_{};
  std::size_t count_ = 0;
};

/// How often stretches stand in a log: of the smallest digests, which are the same ones wherever
/// the measurements stand, and so a sample of all in memory that does not grow.
class StretchCounts {
 public:
  /// Of a log's stretches: more that stand somewhere else are no chance.
  static constexpr double too_many = 0.1;

  void add(std::uint64_t digest);
  [[nodiscard]] const std::map<std::uint64_t, std::size_t>& times() const { return times_; }
  /// All stretches up to this digest are counted.
  [[nodiscard]] std::uint64_t limit() const;

 private:
  std::map<std::uint64_t, std::size_t> times_;
};

/// Stretches of joint angles and torques that stand in one log several times.
class RepeatedStretches {
 public:
  RepeatedStretches(const ChannelPlan& plan, int joints) : plan_(plan), joints_(joints) {}
  void add(const MeasuredRow& row);
  /// Of the stretches in which the joints move, that of those that were there before; 0 to 1.
  [[nodiscard]] double share() const;

 private:
  const ChannelPlan& plan_;
  int joints_;
  Stretch stretch_;
  StretchCounts counts_;
};

}  // namespace shapeid
