// What shapes have in common with ten numbers of their link.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/fast/shape_columns.hpp"

namespace shapeid::fast {

/// u_j . x of its link into the first entries of `products`, for each of these shapes; x has ten
/// numbers a link. Shapes of a link that follow each other are done four at a time.
void column_products(const ShapeColumns& columns, const std::vector<int>& shapes,
                     const Eigen::VectorXd& x, Eigen::VectorXd& products) noexcept;

}  // namespace shapeid::fast
