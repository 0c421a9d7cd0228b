// Bytes as decisions: the first ones of an input say how large things are, the next what numbers
// stand in them. Past the end everything is zero, so that every input means something.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace shapeid::fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* bytes, std::size_t size) : next_(bytes), end_(bytes + size) {}

  [[nodiscard]] bool empty() const { return next_ == end_; }
  [[nodiscard]] std::uint8_t byte() { return empty() ? std::uint8_t{0} : *next_++; }
  [[nodiscard]] bool flag() { return (byte() & 1U) != 0; }
  /// From `fewest` to `most`, which are at most 255 apart.
  [[nodiscard]] int count(int fewest, int most) { return fewest + byte() % (most - fewest + 1); }
  /// In [-1, 1], of two bytes: small integers over 2^15, so exact ties and zeros are common.
  [[nodiscard]] double unit();
  /// Between the bounds.
  [[nodiscard]] double between(double lower, double upper) {
    return lower + 0.5 * (unit() + 1.0) * (upper - lower);
  }
  /// Zero, one, or a number of either sign whose size is anything up to ten to the `decades`.
  [[nodiscard]] double wild(int decades);
  [[nodiscard]] Eigen::VectorXd units(Eigen::Index size);
  [[nodiscard]] Eigen::Vector3d vector(double bound) { return bound * units(3); }
  /// Of length one.
  [[nodiscard]] Eigen::Vector3d direction();
  [[nodiscard]] Eigen::Matrix3d rotation();

 private:
  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

}  // namespace shapeid::fuzz
