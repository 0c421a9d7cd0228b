// Random numbers that are the same on every platform: the standard fixes mt19937_64, but not
// std::normal_distribution.
#pragma once

#include <cstdint>
#include <random>

namespace shapeid {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Evenly spread over [0, 1): the engine's upper 53 bits.
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double lower, double upper);
  /// Gaussian of mean 0 and deviation 1, by Box and Muller.
  [[nodiscard]] double normal();

 private:
  std::mt19937_64 engine_;
  bool has_spare_ = false;
  double spare_ = 0.0;
};

}  // namespace shapeid
