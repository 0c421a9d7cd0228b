// Volume and unit parameters of a shape, enclosed: whether a column is what its shape makes.
#pragma once

#include <array>
#include <optional>

#include "shapeid/models/shape.hpp"
#include "shapeid/proofs/certificate/enclosure.hpp"

namespace shapeid::certificate {

struct ExactMoments {
  Enclosure volume;                      ///< m^3
  std::array<Enclosure, 10> parameters;  ///< of unit mass and uniform density
};

/// Of the shape as its doubles describe it, by integrals of 1, x and x x^T over its cell, one
/// formula a kind, none of them shared with models/. Exact but for sines. Empty for angles beyond
/// what is enclosed, and for shapes without volume.
[[nodiscard]] std::optional<ExactMoments> exact_moments(const Shape& shape);

}  // namespace shapeid::certificate
