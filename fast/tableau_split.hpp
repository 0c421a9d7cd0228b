// A passive shape of the tableau is divided: its column becomes those of two parts.
#pragma once

#include <cstddef>

#include "shapeid/fast/tableau.hpp"

namespace shapeid::fast::tableau {

/// A division: of the whole one part remains, and the other, shape `j`, goes.
struct Parts {
  const double *remains, *goes;  ///< their columns
  double sizes[2];               ///< what they are of the whole's volume
  int j;
  double bound;      ///< of the length of R times the column that goes
  double shared;     ///< stiffness of the whole, which both feel as long as they move together
  double stiffness;  ///< of the part that goes
};

struct Split {
  bool is_clear;  ///< or nothing has changed
  /// Where the part that goes is passive; most_passive if nowhere.
  std::size_t other;
};

/// Of the shape at `place`. Not clear where the parts can hardly be told apart.
[[nodiscard]] Split split(Tableau& t, std::size_t place, const Parts& parts) noexcept;

}  // namespace shapeid::fast::tableau
