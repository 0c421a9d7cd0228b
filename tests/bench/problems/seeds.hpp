// Two sets of inputs: one to look at while tuning, one that only published runs see.
#pragma once

#include <cstdint>

namespace shapeid::bench {

enum class SeedSet { tuning, published };

/// Seeds of the two sets never meet: published ones start at 2^32.
[[nodiscard]] constexpr std::uint64_t seed_of(SeedSet set, std::uint64_t number) {
  return (set == SeedSet::published ? std::uint64_t{1} << 32U : std::uint64_t{0}) + number;
}

}  // namespace shapeid::bench
