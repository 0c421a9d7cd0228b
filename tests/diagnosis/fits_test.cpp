// Which blocks are left out together, and what counts as evidence in a fit of them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/credibility.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/diagnosis/fits_around.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double of_the_prior = 1e-6;  // it is a million wide

/// One column of ones; the force is the same in all samples of a block.
Tally constant_forces(const std::vector<std::pair<std::size_t, double>>& logs_and_forces) {
  constexpr double samples = 5.0;
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (const auto& [log, force] : logs_and_forces) {
    Block block;
    block.log = log;
    block.samples = 5;
    block.sums.resize(2, 2);
    block.sums << samples, samples * force, samples * force, samples * force * force;
    tally.blocks.push_back(block);
  }
  return tally;
}

Eigen::VectorXd held_out(const std::vector<std::pair<std::size_t, double>>& blocks, int folds) {
  const Eigen::VectorXd given = Eigen::VectorXd::Zero(1), wide = Eigen::VectorXd::Constant(1, 1e6);
  const BlockFits fits(constant_forces(blocks), given, wide, folds);
  return fits.held_out({{"level", {0}, {false}, 0}}) / 5.0;
}

// Each log is predicted by the others alone: the mean of their levels.
TEST(Folds, AreWholeLogsWhereThereAreThree) {
  const Eigen::VectorXd error =
      held_out({{0, 1.0}, {0, 1.0}, {1, 2.0}, {1, 2.0}, {2, 6.0}, {2, 6.0}}, 6);
  const Eigen::VectorXd expected = Eigen::Vector3d(9.0, 2.25, 20.25);
  for (Eigen::Index b = 0; b < 6; ++b) EXPECT_NEAR(error[b], expected[b / 2], of_the_prior) << b;
}

// Of two logs each says too much that the other does not: stretches of both are left out.
TEST(Folds, AreStretchesOfOneLogOrTwo) {
  // Without one of the four the mean of the others is 2 or 3: 2 away, and 3 away of a whole log.
  const Eigen::VectorXd error = held_out({{0, 1.0}, {0, 1.0}, {1, 4.0}, {1, 4.0}}, 4);
  for (Eigen::Index b = 0; b < 4; ++b) EXPECT_NEAR(error[b], 4.0, of_the_prior) << b;
  const Eigen::VectorXd one = held_out({{0, 1.0}, {0, 2.0}, {0, 3.0}, {0, 6.0}}, 2);
  const std::vector<double> expected = {12.25, 6.25, 2.25, 20.25};
  for (Eigen::Index b = 0; b < 4; ++b) {
    EXPECT_NEAR(one[b], expected[static_cast<std::size_t>(b)], of_the_prior) << b;
  }
}

/// Four columns over three samples, the second twice the first and the third of zeros.
TEST(Fits, OnlyNumbersThatShowAreCounted) {
  Tally tally;
  tally.inertial = 4;
  tally.width = 5;
  Eigen::Matrix<double, 3, 5> rows;
  rows << 1.0, 2.0, 0.0, 0.5, 1.0,  //
      -1.0, -2.0, 0.0, 0.25, 0.0,   //
      3.0, 6.0, 0.0, -1.0, 2.0;
  for (int b = 0; b < 2; ++b) {
    Block block;
    block.samples = 3;
    block.sums = rows.transpose() * rows;
    tally.blocks.push_back(block);
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(4);
  const BlockFits fits(tally, zero, Eigen::VectorXd::Constant(4, 1e6), 2);
  const auto shown = [&](std::vector<Eigen::Index> columns) {
    const std::vector<bool> any(columns.size(), false);
    return fits.numbers_shown({"some", std::move(columns), any, 0});
  };
  EXPECT_EQ(shown({0, 1, 2, 3}), 2);
  EXPECT_EQ(shown({0, 1}), 1);
  EXPECT_EQ(shown({0, 3}), 2);
  EXPECT_EQ(shown({2}), 1) << "nothing that is tried is less than one chance";
}

/// A mean of N numbers of unit variance, held by a prior as sure as N r of them: it moves with the
/// noise by sqrt(N) / (N + N r) alone. (In every block the noise is as large and adds up to
/// nothing.)
TEST(Fits, WhatThePriorHoldsMovesLessWithTheNoise) {
  constexpr double of_block = 1000.0, blocks = 20.0, count = of_block * blocks;
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (int b = 0; b < 20; ++b) {
    Block block;
    block.samples = 1000;
    block.sums = Eigen::Vector2d(of_block, of_block).asDiagonal();
    tally.blocks.push_back(block);
  }
  tally.blocks.back().freedom = count + 1.0;
  for (const double ratio : {1e-9, 0.5, 50.0}) {
    const double size = 1.0 / std::sqrt(count * ratio);
    BlockFits fits(tally, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, size), 8);
    fits.set_prior(1.0);
    const Fit fit = fits.fit({{"mean", {0}, {false}, 0}});
    EXPECT_EQ(fit.freedom, count);
    EXPECT_NEAR(fit.standard_error[0] * std::sqrt(count) * (1.0 + ratio), 1.0, 1e-6) << ratio;
    EXPECT_EQ(fit.between_blocks[0], 0.0);
  }
}

TEST(Fits, ASquareOfNoiseIsOfBothLogs) {
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (int b = 0; b < 100; ++b) {
    Block block;
    block.samples = 1000;
    block.sums = Eigen::Vector2d(1000.0, 1000.0).asDiagonal();
    block.freedom = 1000.0;
    block.reference = b < 90;
    tally.blocks.push_back(block);
  }
  const BlockFits fits(tally, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), 8);
  const std::vector<Term> mean = {{"mean", {0}, {false}, 0}};
  EXPECT_EQ(fits.square_of_noise(fits.held_out(mean).sum()), 1.0);
  EXPECT_EQ(fits.fit(mean).freedom, 99999.0);
}

/// Each block of either log is predicted without its stretch, and a term counts where it acts: what
/// came in the log alone, what went in the reference alone.
TEST(Fits, TermsCountInTheBlocksInWhichTheyAct) {
  Tally tally;
  tally.inertial = 2;
  tally.width = 3;
  constexpr int of_reference = 24, of_both = 40;
  for (int b = 0; b < of_both; ++b) {
    // A column of ones, one of nothing, and a force of 2 in the reference log and of 3 in the log.
    const Eigen::Vector3d row(1.0, 0.0, b < of_reference ? 2.0 : 3.0);
    Block& block = tally.blocks.emplace_back();
    block.samples = 10;
    block.sums = 10.0 * row * row.transpose();
    block.freedom = 10.0;
    block.reference = b < of_reference;
  }
  const BlockFits fits(tally, Eigen::VectorXd::Zero(2), Eigen::VectorXd::Constant(2, 1e6), 8);
  ASSERT_EQ(fits.blocks(), of_both);
  ASSERT_EQ(fits.log_blocks(), of_both - of_reference);
  const auto of_time = [&](When when) {
    AppliedEffect effect = test::effect("viscous_friction", 0, {0.0});
    effect.when = when;
    Term term{"number", {0}, {false}};
    fits.limit_to_time_of(effect, term);
    return term;
  };
  for (const auto& [when, number] : {std::pair(When::since_reference, 3.0), {When::gone, 2.0}}) {
    const bool came = when == When::since_reference;
    const Term term = of_time(when);
    EXPECT_NEAR(fits.fit({term}).value[0], number, 1e-6);
    const Term nothing{"nothing", {1}, {false}};
    const Eigen::VectorXd error = fits.held_out({nothing, term}), none = fits.held_out({nothing});
    const FitsAround around(fits, {nothing});
    EXPECT_LT((around.with(term) - error).norm(), 1e-9 * none.norm());
    EXPECT_LT((FitsAround(fits, {nothing, term}).error() - error).norm(), 1e-9 * none.norm());
    for (int b = 0; b < of_both; ++b) {
      const bool acts = (b >= of_reference) == came;
      EXPECT_NEAR(error[b], acts ? 0.0 : none[b], 1e-6) << b;
    }
  }
  const Fit both = fits.fit({of_time(When::always), of_time(When::gone)});
  EXPECT_NEAR(both.value[0], 3.0, 1e-6);
  EXPECT_NEAR(both.value[1], -1.0, 1e-6);
  EXPECT_LT(fits.held_out({of_time(When::always), of_time(When::gone)}).sum(), 1e-6);
}

/// Where sums cancel to their rounding no error is negative, and none is less than another.
TEST(Fits, WhatIsExactHasNoGain) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Tally tally;
  tally.inertial = 3;
  tally.width = 4;
  for (int b = 0; b < 20; ++b) {
    Eigen::MatrixXd M(50, 4);
    for (double& x : M.reshaped()) x = normal(random);
    M.col(3) = M.leftCols(2) * Eigen::Vector2d(1e3, -2e3);
    Block& block = tally.blocks.emplace_back();
    block.samples = 50;
    block.freedom = 50.0;
    block.sums = M.transpose() * M;
  }
  BlockFits fits(tally, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Constant(3, 1e4), 8);
  fits.set_prior(1e-4);
  const Term both{"both", {0, 1}, {false, false}, 0}, none{"none", {2}, {false}, 0};
  const Eigen::VectorXd exact = fits.held_out({both}), more = fits.held_out({both, none});
  EXPECT_GT(exact.minCoeff(), 0.0);
  EXPECT_EQ(gain_of(exact, more).t, 0.0);
  const FitsAround around(fits, {both});
  EXPECT_EQ(gain_of(around.error(), around.with(none)).t, 0.0);
  EXPECT_GT(gain_of(around.without(0), around.error()).t, 2.5);
}

TEST(Fits, ZeroOverAnErrorOfZeroIsNoEvidence) {
  const Eigen::ArrayXd errors =
      errors_from_zero(Eigen::Vector4d(0.0, -3.0, 0.0, 2.0), Eigen::Vector4d(0.0, 1.5, 1.0, 0.0));
  EXPECT_EQ(errors[0], 0.0);
  EXPECT_EQ(errors[1], -2.0);
  EXPECT_EQ(errors[2], 0.0);
  EXPECT_TRUE(std::isinf(errors[3]));
}

/// Of a load mass and moments, whichever shows; its moments of inertia alone make none.
TEST(Fits, ALoadWeighsOrHangs) {
  const Effect& load = *find_effect("payload");
  const auto differs = [&](Eigen::Index p) {
    Eigen::VectorXd value = Eigen::VectorXd::Zero(10), error = Eigen::VectorXd::Ones(10);
    error[0] = 0.0;  // no torque shows the mass
    value[p] = -7.0;
    return differs_from_zero(load, value, error, 1.0);
  };
  for (const Eigen::Index moment : {1, 2, 3}) EXPECT_EQ(differs(moment), 7.0);
  for (const Eigen::Index inertia : {4, 9}) EXPECT_EQ(differs(inertia), 0.0);
}

TEST(Folds, NoBlockHasTwoLogs) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  Tally tally = empty_tally(robot, {});
  TallyOptions options;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  options.block_seconds = log.duration() / 4.0;
  const std::size_t third = log.samples().size() / 3;
  options.log_starts = {third, 2 * third};
  add_to_tally(tally, robot, ContactTreatment::ignore, RichModel{stacked_parameters(robot), {}},
               log, options, false);
  ASSERT_EQ(tally.blocks.size(), 6U);
  const std::vector<std::size_t> logs = {0, 0, 1, 1, 2, 2};
  for (std::size_t b = 0; b < logs.size(); ++b) EXPECT_EQ(tally.blocks[b].log, logs[b]);
}

}  // namespace
}  // namespace shapeid::diagnosis
