// Mass problems that bytes spell: well-formed, and nothing else is promised of them.
#pragma once

#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::fuzz {

/// No rows to twelve, no shapes to eight on one or two links; columns of zeros, equal and opposite
/// ones; numbers up to ten to the `decades` larger or smaller than one. Shapes belong to a link
/// each.
[[nodiscard]] MassProblem any_problem(Bytes& bytes, int decades);

}  // namespace shapeid::fuzz
