#include "shapeid/models/alignment.hpp"

namespace shapeid {

template <int bytes, bool malloc_aligns>
void built_with_this_alignment_of_eigen() noexcept {}

template void built_with_this_alignment_of_eigen<EIGEN_MAX_STATIC_ALIGN_BYTES,
                                                 EIGEN_MALLOC_ALREADY_ALIGNED != 0>() noexcept;

}  // namespace shapeid
