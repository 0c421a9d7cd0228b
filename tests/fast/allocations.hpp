// Counts how often a thread asks for memory, whoever asks: malloc and its kin are interposed for
// the whole program, and operator new and Eigen call them.
#pragma once

#include <cstddef>

namespace shapeid::test {

/// Requests for memory by this thread since it started.
[[nodiscard]] std::size_t allocations() noexcept;

/// Requests for memory by this thread while `work` runs.
template <typename Work>
[[nodiscard]] std::size_t allocations_during(Work&& work) {
  const std::size_t before = allocations();
  work();
  return allocations() - before;
}

}  // namespace shapeid::test
