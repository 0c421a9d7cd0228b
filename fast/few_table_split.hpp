// A shape of the table of few is divided: its column becomes those of two parts.
#pragma once

#include <cstddef>

#include "shapeid/fast/few_table.hpp"

namespace shapeid::fast::few {

/// A division.
struct Cut {
  std::size_t whole, part;    ///< one part takes the place of the whole, the other is the last
  double remains, goes;       ///< what they are of the whole's volume
  double shared;              ///< stiffness of the whole: parts that move together feel it
  double remaining, leaving;  ///< the parts' own
};

/// The whole's column is the sum of the parts' columns, those of U, each times its size. So the new
/// part becomes passive beside the whole, and then masses go over: unless the whole is not passive,
/// or the part depends on what is.
void split(Table& now, const Problem& problem, const Cut& cut) noexcept;

}  // namespace shapeid::fast::few
