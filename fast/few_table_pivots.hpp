// Principal pivots on the normal equations of few shapes, until no mass is negative and no slope
// positive.
#pragma once

#include <cstddef>
#include <span>

#include "shapeid/fast/few_table.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast::few {

/// H = A^T A and q = A^T c with A = R U, nothing exchanged, and what bounds the columns of A.
/// Returns the square of || c ||.
[[nodiscard]] double form(const Problem& problem, Table& now, Dozen& sizes) noexcept;

/// The density term's part of H.
void stiffen(Table& now, const Dozen& stiffness, std::size_t shapes) noexcept;

/// Exchanges the passive shapes, as far as their columns do not depend on those before.
void enter(Table& now, std::size_t shapes, std::span<const int> passive) noexcept;

/// Exchanges these passive shapes back, a bit each.
void leave(Table& now, std::size_t shapes, unsigned leaving) noexcept;

/// Pivots until nothing is out of place by more than `smallest`; false if `most_pivots` were too
/// few.
[[nodiscard]] bool pivot(Table& now, std::size_t shapes, double smallest, int most_pivots) noexcept;

/// Of the shapes that are not passive: the largest of slope - threshold x size.
[[nodiscard]] double furthest_above(const Table& now, const Problem& problem, const Dozen& slopes,
                                    const Dozen& sizes, double threshold) noexcept;

}  // namespace shapeid::fast::few
