#include "shapeid/reference/determination.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include "shapeid/reference/triangle.hpp"

namespace shapeid::reference {

Determination determine(const std::vector<RowBlock>& blocks, const Eigen::VectorXd& natural_size) {
  const Eigen::Index n = natural_size.size();
  Eigen::MatrixXd all(0, n + 1);
  for (const RowBlock& block : blocks) all = triangle(stacked(all, block.rows));

  const auto scale = natural_size.asDiagonal();
  const Eigen::MatrixXd Y = all.leftCols(n) * scale;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Y, Eigen::ComputeThinU | Eigen::ComputeFullV);

  Determination result;
  result.standard_error = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  result.determined.assign(static_cast<std::size_t>(n), false);
  // Eigen's default rank threshold: singular values below size x eps x the largest are noise of
  // the factorisation itself.
  result.rank = static_cast<int>(svd.rank());
  if (result.rank == 0) return result;

  const Eigen::MatrixXd V1 = svd.matrixV().leftCols(result.rank);
  const Eigen::VectorXd s = svd.singularValues().head(result.rank);
  const Eigen::VectorXd Phi = svd.solve(all.col(n));  // in natural units
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(result.rank, result.rank);
  for (const RowBlock& block : blocks) {
    const Eigen::MatrixXd Yk = block.rows.leftCols(n) * scale;
    const Eigen::VectorXd g = V1.transpose() * (Yk.transpose() * (Yk * Phi - block.rows.col(n)));
    meat += g * g.transpose();
  }
  const auto count = static_cast<double>(blocks.size());
  if (blocks.size() > 1) meat *= count / (count - 1.0);
  const Eigen::MatrixXd bread = V1 * s.cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::VectorXd variance = (bread * meat * bread.transpose()).diagonal();

  for (Eigen::Index i = 0; i < n; ++i) {
    // The share of parameter i that lies outside of the row space cannot be seen at all.
    const double hidden = svd.matrixV().row(i).tail(n - result.rank).norm();
    if (hidden > std::sqrt(std::numeric_limits<double>::epsilon())) continue;
    const double share = std::sqrt(std::max(variance[i], 0.0));
    result.standard_error[i] = share * natural_size[i];
    result.determined[static_cast<std::size_t>(i)] = blocks.size() > 1 && share < largest_share;
  }
  return result;
}

}  // namespace shapeid::reference
