// Moments of shapes by Gauss-Legendre quadrature in long double: over the coordinates of a cell, or
// over the faces of a solid by the divergence theorem. Shares no formula with the library.
#pragma once

#include <Eigen/Core>

#include "shapeid/models/shape.hpp"

namespace shapeid::test {

/// As Moments, rounded from long double.
[[nodiscard]] Moments integrated(const Shape& shape);

/// For properties: volume right to its own size, centroid to the positions that it is a mean of,
/// central moments to the part's own extent however far away it lies. Solids thinner than their
/// distance from the link origin are only as good as their vertices.
void check_against_quadrature(const Shape& shape);

}  // namespace shapeid::test
