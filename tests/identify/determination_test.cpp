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

/// Plain least squares by its normal equations, of all blocks but one.
VectorXd without_block(const Data& d, std::size_t skipped) {
  const Eigen::Index n = d.rows.front().cols() - 1;
  MatrixXd YtY = MatrixXd::Zero(n, n);
  VectorXd YtF = VectorXd::Zero(n);
  for (std::size_t k = 0; k < d.rows.size(); ++k) {
    if (k == skipped) continue;
    YtY += d.rows[k].leftCols(n).transpose() * d.rows[k].leftCols(n);
    YtF += d.rows[k].leftCols(n).transpose() * d.rows[k].col(n);
  }
  return YtY.inverse() * YtF;
}

// Each block left out in turn, all rows solved again.
TEST(Determination, IsTheJackknifeOfTheWholeRows) {
  const Eigen::Index n = 4;
  for (const int blocks : {2, 3, 6}) {
    const Data d = data(3, blocks, 40, n, 0.3);
    const VectorXd Phi = without_block(d, d.rows.size());
    VectorXd variance = VectorXd::Zero(n);
    for (std::size_t k = 0; k < d.rows.size(); ++k) {
      variance += (without_block(d, k) - Phi).cwiseAbs2();
    }
    variance *= (blocks - 1.0) / blocks;

    const Determination found = determine(d.blocks(), VectorXd::Ones(n));
    EXPECT_EQ(found.rank, 4);
    for (Eigen::Index i = 0; i < n; ++i) {
      // Well conditioned (cond about 1.5): half of the digits are more than enough to tell them
      // apart from any other formula.
      EXPECT_NEAR(found.standard_error[i] / std::sqrt(variance[i]), 1.0, 1e-8);
      EXPECT_TRUE(blocks < 6 || found.determined[static_cast<std::size_t>(i)]);
    }
  }
}

// Column 1 is felt in the first block alone: its error there is nothing, whatever the noise.
TEST(Determination, WhatOneBlockAloneTellsHasNoSpread) {
  Data d = data(13, 3, 40, 3, 0.3);
  d.rows[1].col(1).setZero();
  d.rows[2].col(1).setZero();
  const Determination found = determine(d.blocks(), VectorXd::Ones(3));
  EXPECT_EQ(found.rank, 3);
  EXPECT_TRUE(std::isinf(found.standard_error[1]));
  EXPECT_EQ(found.determined, (std::vector<bool>{true, false, true}));
}

// A number that shapes or bounds hold may be far from what the data say.
TEST(Determination, TellsWhatTheDataSay) {
  const Data d = data(17, 8, 40, 2, 0.3);
  const VectorXd Phi = without_block(d, d.rows.size());
  const Determination found = determine(d.blocks(), VectorXd::Ones(2));
  for (Eigen::Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(found.value[i] / Phi[i], 1.0, 1e-8);
    const double three = 3.0 * found.wider * found.standard_error[i];
    EXPECT_GT(found.wider, 1.0);
    EXPECT_TRUE(found.agrees(i, Phi[i] + 0.99 * three));
    EXPECT_FALSE(found.agrees(i, Phi[i] - 1.01 * three));
  }
}

/// Ten parameters of these values, errors and natural sizes, all called determined.
Determination ten_parameters(const VectorXd& value, double error, double size) {
  Determination ten;
  ten.value = value;
  ten.standard_error = VectorXd::Constant(10, error);
  ten.determined.assign(10, true);
  ten.natural_size = VectorXd::Constant(10, size);
  return ten;
}

// Three errors below zero, of a mass or a moment of inertia: no body is so. First moments and
// products may be.
TEST(Determination, TakesBackWhatNoBodyHas) {
  Determination data = ten_parameters(VectorXd::Constant(10, -3.01), 1.0, 100.0);
  take_back(data, {});
  EXPECT_EQ(data.determined,
            (std::vector<bool>{false, true, true, true, false, true, true, false, true, false}));
  data = ten_parameters(VectorXd::Constant(10, -2.99), 1.0, 100.0);
  take_back(data, {});
  EXPECT_EQ(data.determined, std::vector<bool>(10, true)) << "within its errors of a body's";
}

// A filter that moves a number by more than errors allow adds to its error; which then may be too
// large for it to be determined.
TEST(Determination, TakesBackWhatHangsOnTheFilter) {
  const VectorXd value = VectorXd::LinSpaced(10, 20.0, 30.0);
  Determination slower = ten_parameters(value, 1.5, 10.0);
  slower.value[1] += 2.9;   // within two of its own errors
  slower.value[2] -= 3.1;   // not, but with it the error is sqrt(1 + 3.1^2), less than 5
  slower.value[3] += 4.95;  // sqrt(1 + 4.95^2) is more
  slower.value[5] -= 9.0;
  slower.standard_error[5] = 5.0;  // the slower filter says little of it
  Determination data = ten_parameters(value, 1.0, 10.0);
  const std::vector<bool> differing = {false, false, true, true, false, false};
  for (std::size_t i = 0; i < differing.size(); ++i) {
    EXPECT_EQ(differ(data, slower, static_cast<Eigen::Index>(i)), differing[i]) << i;
    EXPECT_EQ(differ(slower, data, static_cast<Eigen::Index>(i)), differing[i]) << i;
  }
  take_back(data, slower);
  std::vector<bool> left(10, true);
  left[3] = false;
  EXPECT_EQ(data.determined, left);

  // Errors of few blocks are wider.
  slower.wider = 1.2;
  EXPECT_FALSE(differ(data, slower, 2));
}

// Data without noise have errors far below what rounding makes.
TEST(Determination, RoundingIsNoNoise) {
  constexpr double size = 2.0, error = 1e-17;
  for (const double rounded : {0.9e-12 * size, 1.1e-12 * size}) {
    const bool is_more = rounded > 1e-12 * size;
    Determination data = ten_parameters(VectorXd::Constant(10, -rounded), error, size);
    const Determination slower = ten_parameters(VectorXd::Zero(10), error, size);
    EXPECT_EQ(data.is_impossible(0), is_more);
    EXPECT_EQ(data.agrees(0, 0.0), !is_more);
    EXPECT_EQ(differ(data, slower, 0), is_more);
    take_back(data, slower);
    EXPECT_EQ(data.determined[0], !is_more);
  }
  const Determination found =
      determine(data(19, 3, 20, 2, 0.1).blocks(), Eigen::Vector2d(2.0, 3.0));
  EXPECT_DOUBLE_EQ(found.rounding(1), 3e-12);
}

// An error of a third of the size is enough by many blocks, and not by the spread of two.
TEST(Determination, TwoBlocksMustAgreeMoreClosely) {
  for (const bool few : {false, true}) {
    // Blocks that say 1 + error and 1 - error: the standard error is error / sqrt(blocks - 1).
    const int blocks = few ? 2 : 50;
    const double error = std::sqrt(blocks - 1.0) / 3.0;
    Data d;
    for (int k = 0; k < blocks; ++k) {
      d.rows.push_back(Eigen::RowVector2d(1.0, 1.0 + (k % 2 == 0 ? error : -error)));
    }
    const Determination found = determine(d.blocks(), VectorXd::Ones(1));
    EXPECT_NEAR(found.standard_error[0], 1.0 / 3.0, 1e-8);
    EXPECT_EQ(found.determined[0], !few);
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
  EXPECT_TRUE(std::isinf(found.standard_error[0]) && std::isinf(found.standard_error[1]));
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
    const auto seed = 100 + static_cast<std::uint64_t>(k);
    const Data d = data(seed, 20, 10, n, 1.0);
    test::Draw draw(seed);
    const double truth = draw.between(1.0, 3.0);
    const double estimate = without_block(d, d.rows.size())[0];
    squares += (estimate - truth) * (estimate - truth);
    predicted += std::pow(determine(d.blocks(), VectorXd::Ones(n)).standard_error[0], 2);
  }
  // A ratio of variances over 200 repetitions scatters by sqrt(2/200) = 0.1: three of them.
  EXPECT_NEAR(predicted / squares, 1.0, 0.3);
}

}  // namespace
}  // namespace shapeid::reference
