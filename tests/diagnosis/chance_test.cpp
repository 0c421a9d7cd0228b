// What chance makes of nothing, against closed forms and against noise.
#include "shapeid/diagnosis/chance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "shapeid/diagnosis/fits.hpp"
#include "shapeid/models/butterworth.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double of_a_table = 5e-4;  // which has three places
constexpr double of_halving = 1e-9;

TEST(Chance, LeastZIsTheNormalQuantile) {
  EXPECT_NEAR(least_z(0.05, 1.0), 1.960, of_a_table);
  EXPECT_NEAR(least_z(0.05, 10.0), 2.807, of_a_table);  // half a percent for each
  EXPECT_NEAR(least_z(0.003, 3.0), 3.291, of_a_table);
}

TEST(Chance, SquaresOfOneNumberAreThoseOfItsQuantile) {
  for (const double p : {0.3, 0.01, 1e-6}) {
    EXPECT_NEAR(least_squares_sum(p, 1), std::pow(least_z(p, 1.0), 2), of_halving * 100.0) << p;
  }
}

// Of an even count the tail is a finite sum: of two exp(-x/2), of four that times 1 + x/2.
TEST(Chance, SquaresOfEvenCountsHaveAClosedForm) {
  for (const double p : {0.5, 0.01, 1e-7}) {
    EXPECT_NEAR(least_squares_sum(p, 2), -2.0 * std::log(p), of_halving * 100.0) << p;
    const double x = least_squares_sum(p, 4);
    EXPECT_NEAR(std::exp(-0.5 * x) * (1.0 + 0.5 * x) / p, 1.0, of_halving * 100.0) << p;
  }
}

/// The same of many, whose sum's logarithm is that of its largest term and what the others add.
TEST(Chance, SquaresOfManyNumbersHaveAClosedForm) {
  for (const int half : {150, 600}) {
    const double x = least_squares_sum(0.01, Eigen::Index{2} * half);
    double tail = 0.0;
    for (int i = 0; i < half; ++i) {
      tail += std::exp(-0.5 * x + i * std::log(0.5 * x) - std::lgamma(i + 1.0));
    }
    EXPECT_NEAR(tail, 0.01, 1e-6) << half;  // rounding of exponents of a thousand
  }
}

TEST(Chance, BandOfTwoPassesIsThatOfTheFilter) {
  constexpr double cutoff = 7.0, rate = 1000.0;
  constexpr int steps = 50000;
  constexpr double step = 0.5 * rate / steps;
  const Butterworth filter(2, cutoff, rate);
  double band = 0.0;
  for (int i = 0; i < steps; ++i) {
    band += std::pow(filter.gain((i + 0.5) * step), 4) * step;
  }
  EXPECT_NEAR(band_of_two_passes * cutoff / band, 1.0, 2e-3);  // three places, the bilinear warp
}

TEST(Chance, SamplesBehindAFilterAreFewerIndependentOnes) {
  Recording log = test::record({});
  EXPECT_EQ(log.independent_share(1), 1.0);
  log.set_independent_rate(0.25 * log.rate());
  EXPECT_EQ(log.independent_share(1), 0.25);
  EXPECT_EQ(log.independent_share(3), 0.75);
  EXPECT_EQ(log.independent_share(5), 1.0);
}

// A number twice its limit by blocks counts twice; squares count by their root.
TEST(Chance, BothMeasuresWeighAlike) {
  EXPECT_DOUBLE_EQ(both(1.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(both(1.44, 1.44), 1.2 * std::sqrt(1.2));
  EXPECT_DOUBLE_EQ(both(2.0, 0.25), 1.0);
  EXPECT_DOUBLE_EQ(both(1.0, 4.0), both(1.0, 400.0));
  EXPECT_LT(both(1.0, 2.0), both(1.0, 2.25));
  EXPECT_EQ(both(2.0, -1.0), 0.0);
  EXPECT_EQ(both(-2.0, 1.0), 0.0);
}

constexpr Eigen::Index columns = 4;
constexpr int blocks = 24, rows = 15;
constexpr double noise = 0.3;

/// Column 0 in all rows; 1 and 2 likewise, and not orthogonal to it; 3 in the first three blocks
/// alone. The force is noise.
Tally of_noise(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Tally tally;
  tally.inertial = columns;
  tally.width = columns + 1;
  for (int b = 0; b < blocks; ++b) {
    Eigen::MatrixXd M(rows, columns + 1);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = static_cast<double>(Eigen::Index{b} * rows + i);
      M.row(i) << 1.0, std::sin(0.1 * t) + 0.5, std::cos(0.37 * t) - 0.2,
          (b < 3 ? std::sin(t) : 0.0), noise * normal(random);
    }
    Block block;
    block.samples = rows;
    block.freedom = rows;
    block.sums = M.transpose() * M;
    tally.blocks.push_back(block);
  }
  return tally;
}

Term term(const std::vector<Eigen::Index>& places) {
  return {"", places, std::vector<bool>(places.size(), false), 0};
}

BlockFits fits_of(Tally tally) {
  // A prior so wide that it does nothing.
  return {std::move(tally), Eigen::VectorXd::Zero(columns), Eigen::VectorXd::Constant(columns, 1e6),
          8};
}

constexpr int logs = 600;

// Over many logs the estimates scatter by the standard error that each log gives. Between blocks
// the one that three blocks determine seems twice as sure as it is, or more.
TEST(Chance, StandardErrorsAreThoseOfNoiseAlsoOfWhatFewBlocksDetermine) {
  std::mt19937_64 random(20240611);
  const auto zero = Eigen::ArrayXd::Zero(columns);
  Eigen::ArrayXd squares = zero, said = zero, between = zero;
  for (int k = 0; k < logs; ++k) {
    const Fit fit = fits_of(of_noise(random)).fit({term({0, 1, 2, 3})});
    squares += fit.value.array().square() / logs;
    said += fit.standard_error.array().square() / logs;
    between += fit.between_blocks.array().square() / logs;
    EXPECT_TRUE((fit.standard_error.array() >= fit.between_blocks.array()).all());
  }
  // The larger one of two is too large by what the one between blocks scatters.
  constexpr double four_errors = 4.0 * 0.058;  // of a variance from 600: sqrt(2 / 600)
  for (Eigen::Index p = 0; p < columns; ++p) {
    EXPECT_GT(said[p] / squares[p], 1.0 - four_errors) << p;
    EXPECT_LT(said[p] / squares[p], 2.0) << p;
  }
  EXPECT_LT(between[3] / squares[3], 0.85);
}

// Of three numbers of nothing the squares sum to three, and exceed their quantile as often as said.
TEST(Chance, WhatATermOfNothingTakesAwayIsASumOfSquares) {
  std::mt19937_64 random(7);
  double sum = 0.0;
  int beyond = 0;
  const double limit = least_squares_sum(0.1, 3);
  for (int k = 0; k < logs; ++k) {
    const BlockFits fits = fits_of(of_noise(random));
    const double taken = squares_sum(fits.fit({term({0})}), fits.fit({term({0}), term({1, 2, 3})}));
    sum += taken / logs;
    beyond += taken > limit ? 1 : 0;
  }
  EXPECT_NEAR(sum, 3.0, 4.0 * std::sqrt(6.0 / logs));
  EXPECT_NEAR(beyond, 0.1 * logs, 4.0 * std::sqrt(0.09 * logs));
}

}  // namespace
}  // namespace shapeid::diagnosis
