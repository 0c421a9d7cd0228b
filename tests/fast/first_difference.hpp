// Where the fast regressor leaves the reference, and on which input.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// Empty if `Y` holds the columns of `links` of reference::regressor(robot, sample) to a few
/// hundred roundings. Otherwise the first entry that differs, row by row, both numbers, and the
/// input.
[[nodiscard]] std::string first_difference(const Eigen::MatrixXd& Y, const Robot& robot,
                                           const std::vector<int>& links, const Sample& sample);

}  // namespace shapeid::test
