// A load whose motion stays in a plane: what lies across it is nothing that the rows feel.
#pragma once

#include <cstdint>

#include "shapeid/tests/support/any_model.hpp"

namespace shapeid::test {

/// 1 kg of 4 cm, swung and shaken in the plane of x and z, within a cuboid that is far the longest
/// along y. Rows of force along x and z and of moment about y.
[[nodiscard]] ModelWithRows planar_load(std::uint64_t seed, double relative_noise);

}  // namespace shapeid::test
