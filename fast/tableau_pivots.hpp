// Principal pivots: shapes of a link enter and leave its tableau until no mass is negative and no
// shape wants to enter.
#pragma once

#include <array>
#include <cstddef>

#include "shapeid/fast/price_chunk.hpp"
#include "shapeid/fast/tableau.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast::tableau {

/// Shapes whose slope single precision cannot tell from zero: mostly such whose columns depend on
/// the passive ones.
struct Doubtful {
  std::array<int, 16> shapes;
  std::size_t count = 0;
};

enum class Stop {
  settled,   ///< nothing wants to enter
  doubtful,  ///< single precision cannot tell, or what wants to enter cannot
  endless    ///< too many pivots, or rounding has made what should be positive negative
};

/// No passive shapes. K is written as they enter. `lengths` bound the columns of R.
void fill(Tableau& t, const std::array<Dozen, 10>& rows, const Dozen& lengths,
          Dozen& inverse_lengths) noexcept;

/// False if the shape depends on the passive ones, or there is no place for it.
[[nodiscard]] bool enter(Tableau& t, const Problem& problem, const Lane& lane) noexcept;
void leave(Tableau& t, std::size_t place) noexcept;

/// A mass that is not positive leaves, or else the steepest shape enters; `pivots` counts them.
[[nodiscard]] Stop pivot(Tableau& t, const Problem& problem, int most_pivots, int& pivots) noexcept;

/// The shapes whose slope single precision does not show to be negative; false if there are too
/// many.
[[nodiscard]] bool find_doubtful(const Dozen& g, const Problem& problem,
                                 Doubtful& doubtful) noexcept;

}  // namespace shapeid::fast::tableau
