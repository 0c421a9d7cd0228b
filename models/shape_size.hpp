// Whether a shape's size is one that can be computed with. Internal to models.
#pragma once

#include "shapeid/models/shape.hpp"

namespace shapeid {

/// Empty if the volume lies between a cubic angstrom and that of a star, and all moments are
/// finite: beyond that squares of lengths leave the range of double.
[[nodiscard]] Violation why_no_size(const Shape& shape);

}  // namespace shapeid
