// Whether a body with ten given parameters can exist, decided exactly.
#pragma once

#include "shapeid/proofs/certificate/rational.hpp"

namespace shapeid::certificate {

/// Of the pseudo-inertia: positive definite (a body with volume), semidefinite with mass or zero
/// (on the edge: a plate, a rod, a point, nothing), or neither (no such body exists).
enum class Existence { definite, semidefinite, impossible };

/// `parameters`: m, m rx, m ry, m rz, Ixx, Ixy, Ixz, Iyy, Iyz, Izz about the frame's origin.
[[nodiscard]] Existence existence(const Vector& parameters);

}  // namespace shapeid::certificate
