#include "shapeid/reference/determination.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::reference {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Data {
  std::vector<MatrixXd> rows;  ///< [Y F] of each block, not reduced
  [[nodiscard]] std::vector<RowBlock> blocks() const {
    std::vector<RowBlock> reduced;
    for (const MatrixXd& r : rows) reduced.push_back({triangle(r)});
    return reduced;
  }
};

/// Blocks of a linear model with `noise` of unit size; column `hidden` (if any) repeats column 0.
Data data(std::uint64_t seed, int block_count, int rows, Eigen::Index n, double noise,
          Eigen::Index hidden = -1) {
  test::Draw draw(seed);
  VectorXd truth(n);
  for (double& x : truth) x = draw.between(1.0, 3.0);
  Data result;
  for (int k = 0; k < block_count; ++k) {
    MatrixXd block(rows, n + 1);
    for (int i = 0; i < rows; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) block(i, j) = draw.normal();
      if (hidden >= 0) block(i, hidden) = block(i, 0);
      block(i, n) = block.row(i).head(n) * truth + noise * draw.normal();
    }
    result.rows.push_back(block);
  }
  return result;
}

// The sandwich written out with the rows themselves and plain inverses.
TEST(Determination, IsTheSandwichOfTheWholeRows) {
  const Eigen::Index n = 4;
  const Data d = data(3, 6, 40, n, 0.3);
  MatrixXd YtY = MatrixXd::Zero(n, n);
  VectorXd YtF = VectorXd::Zero(n);
  for (const MatrixXd& r : d.rows) {
    YtY += r.leftCols(n).transpose() * r.leftCols(n);
    YtF += r.leftCols(n).transpose() * r.col(n);
  }
  const VectorXd Phi = YtY.inverse() * YtF;
  MatrixXd meat = MatrixXd::Zero(n, n);
  for (const MatrixXd& r : d.rows) {
    const VectorXd g = r.leftCols(n).transpose() * (r.leftCols(n) * Phi - r.col(n));
    meat += g * g.transpose();
  }
  const MatrixXd covariance = 6.0 / 5.0 * YtY.inverse() * meat * YtY.inverse();

  const Determination found = determine(d.blocks(), VectorXd::Ones(n));
  EXPECT_EQ(found.rank, 4);
  for (Eigen::Index i = 0; i < n; ++i) {
    // Well conditioned (cond about 1.5): half of the digits are more than enough to tell them apart
    // from any other formula.
    EXPECT_NEAR(found.standard_error[i] / std::sqrt(covariance(i, i)), 1.0, 1e-8);
    EXPECT_TRUE(found.determined[static_cast<std::size_t>(i)]);
  }
}

// Standard errors have the parameter's unit; what is determined does not depend on units.
TEST(Determination, FollowsTheUnits) {
  const Eigen::Index n = 3;
  const Data d = data(5, 8, 30, n, 2.0);
  const VectorXd unit = Eigen::Vector3d(1e3, 1.0, 1e-4);  // new unit in old units
  Data other = d;
  for (MatrixXd& r : other.rows) r.leftCols(n) = (r.leftCols(n) * unit.asDiagonal()).eval();
  const Determination a = determine(d.blocks(), VectorXd::Ones(n));
  const Determination b = determine(other.blocks(), unit.cwiseInverse());
  for (Eigen::Index i = 0; i < n; ++i) {
    EXPECT_NEAR(b.standard_error[i] * unit[i] / a.standard_error[i], 1.0, 1e-8);
  }
  EXPECT_EQ(a.determined, b.determined);
}

TEST(Determination, HiddenDirectionsAreInfinitelyUncertain) {
  const Data d = data(7, 6, 40, 4, 0.3, 2);
  const Determination found = determine(d.blocks(), VectorXd::Ones(4));
  EXPECT_EQ(found.rank, 3);
  EXPECT_TRUE(std::isinf(found.standard_error[0]));
  EXPECT_TRUE(std::isinf(found.standard_error[2]));
  EXPECT_TRUE(std::isfinite(found.standard_error[1]));
  EXPECT_EQ(found.determined, (std::vector<bool>{false, true, false, true}));
}

TEST(Determination, NoiseBeyondTheNaturalSizeDeterminesNothing) {
  const Determination found = determine(data(9, 6, 20, 2, 50.0).blocks(), VectorXd::Ones(2));
  EXPECT_EQ(found.determined, (std::vector<bool>{false, false}));
}

TEST(Determination, OneBlockHasNoSpread) {
  const Determination found = determine(data(11, 1, 50, 2, 0.1).blocks(), VectorXd::Ones(2));
  EXPECT_EQ(found.determined, (std::vector<bool>{false, false}));
}

TEST(Determination, RowsOfZerosDetermineNothing) {
  const std::vector<RowBlock> blocks(3, RowBlock{MatrixXd::Zero(4, 4)});
  const Determination found = determine(blocks, VectorXd::Ones(3));
  EXPECT_EQ(found.rank, 0);
  EXPECT_EQ(found.determined, (std::vector<bool>(3, false)));
}

// Over many repetitions the estimate scatters as the standard error says.
TEST(Determination, CoversTheScatter) {
  const int repetitions = 200;
  const Eigen::Index n = 2;
  double squares = 0.0, predicted = 0.0;
  for (int k = 0; k < repetitions; ++k) {
    const auto seed = static_cast<std::uint64_t>(100 + k);
    const Data d = data(seed, 20, 10, n, 1.0);
    test::Draw draw(seed);
    const double truth = draw.between(1.0, 3.0);
    MatrixXd all(0, n + 1);
    for (const MatrixXd& r : d.rows) all = triangle(stacked(all, r));
    const double estimate = all.topLeftCorner(n, n).fullPivLu().solve(all.col(n).head(n))[0];
    squares += (estimate - truth) * (estimate - truth);
    predicted += std::pow(determine(d.blocks(), VectorXd::Ones(n)).standard_error[0], 2);
  }
  // A ratio of variances over 200 repetitions scatters by sqrt(2/200) = 0.1: three of them.
  EXPECT_NEAR(predicted / squares, 1.0, 0.3);
}

}  // namespace
}  // namespace shapeid::reference
