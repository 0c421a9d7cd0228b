// Meshes of hardly any volume.
#pragma once

#include "shapeid/models/shape.hpp"

namespace shapeid::test {

/// A tetrahedron about a metre wide and `thin` times as high, somewhere.
[[nodiscard]] Shape flat_tetrahedron(double thin, unsigned seed);

}  // namespace shapeid::test
