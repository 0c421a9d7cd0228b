// How large what is nothing becomes by chance, where much is tried.
#pragma once

#include <Eigen/Core>

namespace shapeid::diagnosis {

/// Standard errors that none of `parameters` normal numbers of mean zero exceeds, in either
/// direction, but with this probability.
[[nodiscard]] double least_z(double probability, double parameters);

/// `least_t` with many blocks, more with few: the quantile of Student's t of the same level.
[[nodiscard]] double limit_for(double least_t, Eigen::Index blocks);

/// What the sum of the squares of so many independent normal numbers of mean zero and unit variance
/// exceeds with this probability.
[[nodiscard]] double least_squares_sum(double probability, Eigen::Index numbers);

}  // namespace shapeid::diagnosis
