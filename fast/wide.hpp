// Four doubles at a time, on a machine that can.
#pragma once

#include <cstddef>

namespace shapeid::fast {

/// Four doubles side by side, added and multiplied each by itself; two pairs where registers are
/// shorter.
using Four = double __attribute__((vector_size(32)));

/// Wherever they lie in memory.
using LooseFour = double __attribute__((vector_size(32), aligned(8), may_alias));

/// A dozen doubles.
struct Dozen {
  Four part[3] = {};
  double& operator[](std::size_t i) noexcept { return reinterpret_cast<double*>(part)[i]; }
  double operator[](std::size_t i) const noexcept {
    return reinterpret_cast<const double*>(part)[i];
  }
};

/// a += factor b
[[gnu::always_inline]] inline void add(Dozen& a, double factor, const Dozen& b) noexcept {
  a.part[0] += factor * b.part[0];
  a.part[1] += factor * b.part[1];
  a.part[2] += factor * b.part[2];
}

/// The ten numbers from here on, and two zeros.
[[gnu::always_inline]] inline Dozen ten_from(const double* x) noexcept {
  const auto* parts = reinterpret_cast<const LooseFour*>(x);
  return {{parts[0], parts[1], Four{x[8], x[9], 0.0, 0.0}}};
}

/// Eight floats likewise, wherever they lie in memory.
using Eight = float __attribute__((vector_size(32), aligned(4), may_alias));

}  // namespace shapeid::fast

/// A function so marked is compiled twice, and the machine's own version is chosen when the program
/// starts: Four is then one register. No operation changes, and none is fused with another, so the
/// digits are the same on every machine.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__)
#define SHAPEID_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SHAPEID_WIDE
#endif
