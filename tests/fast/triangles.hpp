// Rows to compress, and how far a triangle is from them.
#pragma once

#include <Eigen/Core>

#include "shapeid/fast/triangle.hpp"

namespace shapeid::test {

/// Rows [Y F] whose columns differ in size by up to 1e12, as those of mass and of small tensors do;
/// some columns are zero or depend on others, as those of a fixed base's first links do. Drawn with
/// rapidcheck.
[[nodiscard]] Eigen::MatrixXd arbitrary_rows(Eigen::Index columns, Eigen::Index most_rows);

void add(fast::Triangle& triangle, const Eigen::MatrixXd& rows);
[[nodiscard]] fast::Triangle triangle_of(const Eigen::MatrixXd& rows);

/// How far R^T R is from rows^T rows, each entry against the lengths of the two columns it belongs
/// to: Householder's backward error is small column by column, not only for the largest.
[[nodiscard]] double gram_error(const Eigen::MatrixXd& R, const Eigen::MatrixXd& rows);

}  // namespace shapeid::test
