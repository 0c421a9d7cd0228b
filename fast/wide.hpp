// Four doubles at a time, on a machine that can.
#pragma once

#include <cstddef>

namespace shapeid::fast {

/// Four doubles side by side, added and multiplied each by itself; two pairs where registers are
/// shorter.
using Four = double __attribute__((vector_size(32)));

/// A dozen of them.
struct Dozen {
  Four part[3] = {};
  double& operator[](std::size_t i) noexcept { return reinterpret_cast<double*>(part)[i]; }
  double operator[](std::size_t i) const noexcept {
    return reinterpret_cast<const double*>(part)[i];
  }
};

}  // namespace shapeid::fast

/// A function so marked is compiled twice, and the machine's own version is chosen when the program
/// starts: Four is then one register. No operation changes, and none is fused with another, so the
/// digits are the same on every machine.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__)
#define SHAPEID_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SHAPEID_WIDE
#endif
