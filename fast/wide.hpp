// Four doubles at a time, on a machine that can.
#pragma once

#include <cstddef>
#include <cstdint>

namespace shapeid::fast {

/// Four doubles side by side, added and multiplied each by itself; two pairs where registers are
/// shorter. Eight floats likewise.
using Four = double __attribute__((vector_size(32)));
using Eight = float __attribute__((vector_size(32)));

using FourBits = std::uint64_t __attribute__((vector_size(32)));
using EightBits = std::uint32_t __attribute__((vector_size(32)));

/// The numbers from here on, wherever they lie in memory. (A memcpy would be made in two halves,
/// because it is expanded before the machine is chosen.)
[[gnu::always_inline]] inline void load(const double* x, Four& four) noexcept {
  using Anywhere [[gnu::aligned(8), gnu::may_alias]] = Four;
  four = *reinterpret_cast<const Anywhere*>(x);
}
[[gnu::always_inline]] inline void load(const float* x, Eight& eight) noexcept {
  using Anywhere [[gnu::aligned(4), gnu::may_alias]] = Eight;
  eight = *reinterpret_cast<const Anywhere*>(x);
}
[[gnu::always_inline]] inline void store(const Four& four, double* x) noexcept {
  using Anywhere [[gnu::aligned(8), gnu::may_alias]] = Four;
  *reinterpret_cast<Anywhere*>(x) = four;
}
[[gnu::always_inline]] inline void store(const Eight& eight, float* x) noexcept {
  using Anywhere [[gnu::aligned(4), gnu::may_alias]] = Eight;
  *reinterpret_cast<Anywhere*>(x) = eight;
}

/// |x|: without the sign's bit.
[[gnu::always_inline]] inline void take_sign(Four& x) noexcept {
  x = reinterpret_cast<Four>(reinterpret_cast<FourBits>(x) & ~(std::uint64_t{1} << 63U));
}
[[gnu::always_inline]] inline void take_sign(Eight& x) noexcept {
  x = reinterpret_cast<Eight>(reinterpret_cast<EightBits>(x) & ~(std::uint32_t{1} << 31U));
}

/// A dozen doubles; zero, to begin with. Zeroed and copied four at a time, so that what is read
/// next was written as a whole: as members GCC makes a string instruction of the zeros and copies
/// two at a time, and either takes as long as half a pivot. Aligned as the longer registers want
/// it: GCC gives Four the alignment of the shorter ones, and reads it by the longer.
struct alignas(32) Dozen {
  Four part[3];
  [[gnu::always_inline]] Dozen() noexcept { part[0] = part[1] = part[2] = Four{}; }
  [[gnu::always_inline]] Dozen(const Dozen& other) noexcept {
    for (std::size_t p = 0; p < 3; ++p) part[p] = other.part[p];
  }
  // Onto itself it changes nothing. NOLINTNEXTLINE(bugprone-unhandled-self-assignment)
  [[gnu::always_inline]] Dozen& operator=(const Dozen& other) noexcept {
    for (std::size_t p = 0; p < 3; ++p) part[p] = other.part[p];
    return *this;
  }
  ~Dozen() = default;
  double& operator[](std::size_t i) noexcept { return reinterpret_cast<double*>(part)[i]; }
  double operator[](std::size_t i) const noexcept {
    return reinterpret_cast<const double*>(part)[i];
  }
  [[nodiscard]] const double* data() const noexcept {
    return reinterpret_cast<const double*>(part);
  }
};

static_assert(alignof(Dozen) == sizeof(Four));

/// The places of a dozen, and the low bits of a number that can hold one.
alignas(32) constexpr FourBits dozen_places[] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}};
constexpr std::uint64_t place_bits = 15;

/// a += factor b
[[gnu::always_inline]] inline void add(Dozen& a, double factor, const Dozen& b) noexcept {
  a.part[0] += factor * b.part[0];
  a.part[1] += factor * b.part[1];
  a.part[2] += factor * b.part[2];
}

/// Sum of the products.
[[gnu::always_inline]] inline double dot(const Dozen& a, const Dozen& b) noexcept {
  const Four sum = a.part[0] * b.part[0] + a.part[1] * b.part[1] + a.part[2] * b.part[2];
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// Keeps the first two, in a register; the others become zero.
[[gnu::always_inline]] inline void keep_two(Four& x) noexcept {
  x = __builtin_shufflevector(x, Four{}, 0, 1, 4, 5);
}

/// Columns of a block of four by four become its rows.
[[gnu::always_inline]] inline void transpose(Four (&block)[4]) noexcept {
  const Four a = __builtin_shufflevector(block[0], block[1], 0, 4, 2, 6);
  const Four b = __builtin_shufflevector(block[0], block[1], 1, 5, 3, 7);
  const Four c = __builtin_shufflevector(block[2], block[3], 0, 4, 2, 6);
  const Four d = __builtin_shufflevector(block[2], block[3], 1, 5, 3, 7);
  block[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  block[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  block[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  block[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// The ten numbers from here on, and two zeros.
[[gnu::always_inline]] inline void load_ten(const double* x, Dozen& dozen) noexcept {
  load(x, dozen.part[0]);
  load(x + 4, dozen.part[1]);
  dozen.part[2] = Four{x[8], x[9], 0.0, 0.0};
}

/// Its first ten.
[[gnu::always_inline]] inline void store_ten(const Dozen& dozen, double* x) noexcept {
  store(dozen.part[0], x);
  store(dozen.part[1], x + 4);
  x[8] = dozen.part[2][0];
  x[9] = dozen.part[2][1];
}

}  // namespace shapeid::fast

/// A function so marked is compiled twice, and the machine's own version is chosen when the program
/// starts: Four is then one register. No operation changes, and none is fused with another
/// (-ffp-contract=off), so the digits are the same on every machine (the test DigitsOfBothWidths).
/// Not under ThreadSanitizer, which is not ready yet when the choice is made, nor for valgrind,
/// which does not know every instruction of the wide one (SHAPEID_NARROW).
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__) && \
    !defined(__SANITIZE_THREAD__) && !defined(SHAPEID_NARROW)
#define SHAPEID_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SHAPEID_WIDE
#endif

/// Likewise, and once more for machines with AVX-512: not for longer registers but for twice as
/// many, which tables of a dozen rows do not fit into otherwise. (Sums over a link's rows gain
/// nothing by it, or lose. Older GCC and clang do not know that machine here.)
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__AVX2__) &&              \
    !defined(__SANITIZE_THREAD__) && !defined(SHAPEID_NARROW) && !defined(__clang__) && \
    __GNUC__ >= 12
#define SHAPEID_WIDE_AND_MANY __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SHAPEID_WIDE_AND_MANY SHAPEID_WIDE
#endif
