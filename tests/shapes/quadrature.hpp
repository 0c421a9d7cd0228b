// Moments of shapes by Gauss-Legendre quadrature in long double: over the coordinates of a cell, or
// over the faces of a solid by the divergence theorem. Shares no formula with the library.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/shape.hpp"

namespace shapeid::test {

/// As Moments, rounded from long double.
[[nodiscard]] Moments integrated(const Shape& shape);

}  // namespace shapeid::test
