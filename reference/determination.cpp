#include "shapeid/reference/determination.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shapeid/models/student.hpp"
#include "shapeid/reference/triangle.hpp"

namespace shapeid::reference {
namespace {

/// Of what all blocks know of a direction, squared: with less than this left without a block, the
/// block alone determines it. Leaving it out would make the error a thousand times larger.
constexpr double least_without = 1e-6;

/// With noise alike in all directions: the largest part of a parameter's variance that may lie in
/// directions which single blocks determine. The rest then stands for the whole.
constexpr double largest_unjudged = 0.5;

/// The level at which errors are widened for few blocks: at two of them.
constexpr double widened_at = 2.0;

/// Of a link's ten parameters those that no body has below zero: m, Ixx, Iyy, Izz.
constexpr std::array<bool, 10> never_negative = {true,  false, false, false, true,
                                                 false, false, true,  false, true};

}  // namespace

bool Determination::is_impossible(Eigen::Index parameter) const {
  return never_negative.at(static_cast<std::size_t>(parameter % 10)) && value[parameter] < 0.0 &&
         !agrees(parameter, 0.0);
}

bool differ(const Determination& a, const Determination& b, Eigen::Index parameter) {
  const double larger =
      std::max(a.wider * a.standard_error[parameter], b.wider * b.standard_error[parameter]);
  return std::abs(a.value[parameter] - b.value[parameter]) >
         std::max(widened_at * larger, std::max(a.rounding(parameter), b.rounding(parameter)));
}

bool is_held(double standard_error, double data_standard_error) {
  // Of the data's variance, the share that is left is how far the number follows the data.
  constexpr double half = 0.5;
  return standard_error * standard_error < half * data_standard_error * data_standard_error;
}

Determination determine(const std::vector<RowBlock>& blocks, const Eigen::VectorXd& natural_size) {
  const Eigen::Index n = natural_size.size();
  Eigen::MatrixXd all(0, n + 1);
  for (const RowBlock& block : blocks) all = triangle(stacked(all, block.rows));

  const auto scale = natural_size.asDiagonal();
  const Eigen::MatrixXd Y = all.leftCols(n) * scale;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Y, Eigen::ComputeThinU | Eigen::ComputeFullV);

  Determination result;
  result.natural_size = natural_size;
  result.value = Eigen::VectorXd::Zero(n);
  result.standard_error = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  result.determined.assign(static_cast<std::size_t>(n), false);
  // Eigen's default rank threshold: singular values below size x eps x the largest are noise of
  // the factorisation itself.
  result.rank = static_cast<int>(svd.rank());
  if (result.rank == 0) return result;

  // Coordinates x = S V1^T Phi, in which Y^T Y is one: a parameter is a row of `of_x` times x.
  const Eigen::MatrixXd of_x = svd.matrixV().leftCols(result.rank) *
                               svd.singularValues().head(result.rank).cwiseInverse().asDiagonal();
  const Eigen::VectorXd Phi = svd.solve(all.col(n));  // in natural units
  result.value = Phi.cwiseProduct(natural_size);
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(n), unjudged = Eigen::VectorXd::Zero(n);
  for (const RowBlock& block : blocks) {
    const Eigen::MatrixXd Yk = block.rows.leftCols(n) * scale;
    const Eigen::MatrixXd Xk = Yk * of_x;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> known(Xk.transpose() * Xk);
    const Eigen::MatrixXd along = of_x * known.eigenvectors();
    const Eigen::VectorXd g =
        known.eigenvectors().transpose() * (Xk.transpose() * (Yk * Phi - block.rows.col(n)));
    Eigen::VectorXd d = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < result.rank; ++i) {
      const double without = 1.0 - known.eigenvalues()[i];
      if (without > least_without) {
        d += g[i] / without * along.col(i);
      } else {
        unjudged += along.col(i).cwiseAbs2();
      }
    }
    variance += d.cwiseAbs2();
  }
  const auto count = static_cast<double>(blocks.size());
  variance *= (count - 1.0) / count;
  unjudged = unjudged.cwiseQuotient(of_x.rowwise().squaredNorm());
  result.wider = limit_for(widened_at, static_cast<Eigen::Index>(blocks.size())) / widened_at;

  for (Eigen::Index i = 0; i < n; ++i) {
    // The share of parameter i that lies outside of the row space cannot be seen at all.
    const double hidden = svd.matrixV().row(i).tail(n - result.rank).norm();
    if (hidden > std::sqrt(std::numeric_limits<double>::epsilon())) continue;
    if (!(unjudged[i] <= largest_unjudged)) continue;
    const double share = std::sqrt(variance[i] / (1.0 - unjudged[i]));
    result.standard_error[i] = share * natural_size[i];
    result.determined[static_cast<std::size_t>(i)] = result.wider * share < largest_share;
  }
  return result;
}

void take_back(Determination& data, const std::optional<Determination>& slower) {
  for (Eigen::Index i = 0; i < data.value.size(); ++i) {
    bool stands = !data.is_impossible(i);
    if (slower && differ(data, *slower, i)) {
      const double move = slower->value[i] - data.value[i];
      const double error = data.wider * std::hypot(data.standard_error[i], move);
      stands = stands && error < largest_share * data.natural_size[i];
    }
    if (!stands) data.determined[static_cast<std::size_t>(i)] = false;
  }
}

}  // namespace shapeid::reference
