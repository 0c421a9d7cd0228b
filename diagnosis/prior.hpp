// How strongly the given inertias hold what the data say nothing about.
#pragma once

#include <vector>

#include "shapeid/diagnosis/fits.hpp"

namespace shapeid::diagnosis {

/// The strongest prior that predicts held-out blocks as well as any, as far as their scatter
/// tells: what the data say nothing about stays as given. Bounded on both sides: a prior that froze
/// the given inertias would have effects found that make up for their errors, and beside one that
/// left them further than their natural size, masses would stand for effects.
/// Sets it and returns it.
double choose_prior(BlockFits& fits, const std::vector<Term>& terms);

/// Whether masses predict held-out blocks better, by more than chance, if nothing holds them than
/// within their natural size: then they stand for something that is no mass.
[[nodiscard]] bool masses_want_more(BlockFits fits, const std::vector<Term>& terms, double least_t);

}  // namespace shapeid::diagnosis
