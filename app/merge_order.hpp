// The order in which the logs of a batch are merged: it depends on how many there are, and on
// nothing else.
#pragma once

#include <cstddef>

namespace shapeid::app {

/// Calls merge(left, right), which is to add what stands at `right` to what stands at `left`, for
/// neighbours, then for neighbours of what came out, until at most `most` (positive) are left. They
/// stand at the multiples of the number that is returned. A process that takes part in some of the
/// calls only can follow the same order without waiting in a circle.
template <class Merge>
std::size_t merge_neighbours(std::size_t count, std::size_t most, Merge merge) {
  std::size_t stride = 1;
  while ((count + stride - 1) / stride > most) {
    for (std::size_t k = 0; k + stride < count; k += 2 * stride) merge(k, k + stride);
    stride *= 2;
  }
  return stride;
}

}  // namespace shapeid::app
