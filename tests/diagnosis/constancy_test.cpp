// The number of an effect is a constant, or what it follows is said.
#include "shapeid/diagnosis/constancy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"

namespace shapeid::diagnosis {
namespace {

/// One parameter of the body, one hypothesis at the first joint, and it times its position; rows
/// with noise. In the log, the last twenty of sixty blocks, the force is 0.4 times that product.
Tally of_a_number_that_follows_the_position(const AppliedEffect& hypothesis) {
  Tally tally;
  tally.inertial = 1;
  tally.hypotheses = {hypothesis};
  tally.first = {1};
  tally.modulations = {{0, Signal::position, 0}};
  tally.first_modulated = {2};
  tally.width = 4;
  std::mt19937 random(5);  // NOLINT: the same in every run
  std::normal_distribution<double> normal;
  for (int b = 0; b < 60; ++b) {
    Block block;
    block.reference = b < 40;
    block.samples = 50;
    block.freedom = 50.0;
    Eigen::MatrixXd M(50, 4);
    for (auto row : M.rowwise()) {
      const double column = 1.0 + 0.1 * normal(random), position = normal(random);
      row << normal(random), column, column * position,
          0.1 * normal(random) + (block.reference ? 0.0 : 0.4 * column * position);
    }
    block.sums = M.transpose() * M;
    tally.blocks.push_back(block);
  }
  return tally;
}

// A transformation has no term of its own that would say from when on it acts: fitted to the
// reference log as well, the number would be less than a third of what it is.
TEST(Constancy, WhatCameSinceTheReferenceIsAskedOfTheLogAlone) {
  AppliedEffect hypothesis = at_start(*find_effect("encoder_offset"), 0);
  const std::vector<Term> body = {{"masses", {0}, {false}, 0}};
  const auto worth = [&](When when) {
    hypothesis.when = when;
    const BlockFits fits(of_a_number_that_follows_the_position(hypothesis),
                         Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), 5);
    const double all = fits.held_out(body).tail(fits.log_blocks()).sum();
    const auto found = variations(fits, body, Eigen::VectorXd::Constant(1, all)).front();
    EXPECT_TRUE(found && found->signal == Signal::position && found->joint == 0);
    return found ? found->share : 0.0;
  };
  // 0.16 of 0.17: the square of what follows, and that of noise beside it.
  EXPECT_NEAR(worth(When::since_reference), 0.16 / 0.17, 0.02);
  // A third of the blocks have it: a third of the number, which leaves two thirds of it in these
  // and puts a third into twice as many.
  constexpr double third = 1.0 / 3.0;
  const double taken = 1.0 - std::pow(1.0 - third, 2) - 2.0 * std::pow(third, 2);
  EXPECT_NEAR(worth(When::always), taken * 0.16 / 0.17, 0.04);
}

}  // namespace
}  // namespace shapeid::diagnosis
