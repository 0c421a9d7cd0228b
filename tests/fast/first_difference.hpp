// Where the fast path leaves the reference, and on which input.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

inline const std::string no_difference;  ///< what is returned where two matrices agree

/// Empty if two matrices agree: every entry's difference is a few hundred roundings of `scale`,
/// with `size` the length of the sums involved. Otherwise the first entry that differs, row by row,
/// both numbers, and the input.
[[nodiscard]] std::string first_difference(const Eigen::MatrixXd& fast,
                                           const Eigen::MatrixXd& reference, double scale,
                                           Eigen::Index size, const Robot& robot,
                                           const Sample& sample);

/// Empty if `Y` holds the columns of `links` of reference::regressor(robot, sample) to a few
/// hundred roundings. Otherwise the first entry that differs, row by row, both numbers, and the
/// input.
[[nodiscard]] std::string first_difference(const Eigen::MatrixXd& Y, const Robot& robot,
                                           const std::vector<int>& links, const Sample& sample);

}  // namespace shapeid::test
