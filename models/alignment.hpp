// Whether a program and the library that it links mean the same by the types that pass between
// them.
#pragma once

#include <Eigen/Core>

namespace shapeid {

/// How Eigen aligns, and what it frees memory by, follows from the compiler's options (-mavx,
/// -march=native, -fsanitize=address), and the sizes of links, contacts and shapes with it. The
/// library has this function for what it was built with alone: of a program that was built
/// otherwise the linker says that it is not there, where the program would crash.
template <int bytes, bool malloc_aligns>
void built_with_this_alignment_of_eigen() noexcept;

[[gnu::used]] static void (*const alignment_is_the_same)() noexcept =
    &built_with_this_alignment_of_eigen<EIGEN_MAX_STATIC_ALIGN_BYTES,
                                        EIGEN_MALLOC_ALREADY_ALIGNED != 0>;

}  // namespace shapeid
