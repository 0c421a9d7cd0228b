// How large what is nothing becomes by chance, where much is tried.
#pragma once

#include <Eigen/Core>

namespace shapeid::diagnosis {

/// Standard errors that none of `parameters` normal numbers of mean zero exceeds, in either
/// direction, but with this probability.
[[nodiscard]] double least_z(double probability, double parameters);

/// What the sum of the squares of so many independent normal numbers of mean zero and unit variance
/// exceeds with this probability.
[[nodiscard]] double least_squares_sum(double probability, Eigen::Index numbers);

/// Two measures of one evidence, each over its own limit, as one: their geometric mean. `blocks`:
/// standard errors by the scatter between blocks, which allows for noise of any colour, and is
/// known badly from some twenty. `squares`: what was taken away of the error by squares of
/// independent noise, many, but of one colour behind the filter; the noise of an encoder's second
/// derivative is blue, and of what is slow there are fewer than that says. Squares of more
/// than 2.25 times their limit count no more: what a model leaves that lacks something is no noise.
[[nodiscard]] double both(double blocks, double squares);

}  // namespace shapeid::diagnosis
