// What few blocks of time can show.
#pragma once

#include <Eigen/Core>

namespace shapeid {

/// `least_t` with many blocks, more with few: the quantile of Student's t of the same level, with
/// one degree of freedom less than there are blocks.
[[nodiscard]] double limit_for(double least_t, Eigen::Index blocks);

}  // namespace shapeid
