// How strongly given inertias hold.
#include "shapeid/diagnosis/prior.hpp"

#include <gtest/gtest.h>

namespace shapeid::diagnosis {
namespace {

constexpr double given_mass = 2.0;

/// One number of usual size one, given as `given`, which is `value` more than that in twenty blocks
/// of a thousand samples each; the noise of a sample is one.
BlockFits fits_of(double value, double given = given_mass) {
  constexpr double samples = 1000.0;
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (int b = 0; b < 20; ++b) {
    Block block;
    block.samples = 1000;
    block.sums.resize(2, 2);
    const double force = given + value;
    block.sums << samples, samples * force, samples * force, samples * (force * force + 1.0);
    tally.blocks.push_back(block);
    tally.freedom += samples;
  }
  return {tally, Eigen::VectorXd::Constant(1, given), Eigen::VectorXd::Ones(1), 8};
}

const std::vector<Term> number = {{"number", {0}, {false}, 0}};

double strength_for(double value) {
  BlockFits fits = fits_of(value);
  const double strength = choose_prior(fits, number);
  EXPECT_EQ(fits.prior(), strength);
  return strength;
}

TEST(Prior, IsTheStrongestWhereTheGivenNumberIsRight) { EXPECT_NEAR(strength_for(0.0), 1e3, 1e-9); }

/// Of 17500 samples beside a prior of 1000 the number falls short by 0.011, which costs the 20000
/// left out 2.3 squares of the noise of one; beside a prior of 100 it costs 0.026. Every block says
/// the same: in standard errors of the difference either is as sure as rounding allows.
TEST(Prior, GivesWayToWhatIsMoreThanOneNumbersNoise) {
  EXPECT_NEAR(strength_for(0.2), 100.0, 1e-9);
}

/// Beside a prior of one this number falls short by 0.057, which costs 65 squares, and beside a
/// tenth of that 0.65: data want it weaker, and it stays at the number's usual size.
TEST(Prior, GivesWayUpToItsSize) { EXPECT_NEAR(strength_for(1000.0), 1.0, 1e-12); }

TEST(Prior, MassesWantMoreWhereTheirSizeIsNotEnough) {
  EXPECT_FALSE(masses_want_more(fits_of(0.0), number, 2.5));
  EXPECT_FALSE(masses_want_more(fits_of(5.0), number, 2.5));  // a fit that is short by 3e-4
  EXPECT_TRUE(masses_want_more(fits_of(1000.0), number, 2.5));
}

/// Of a link without mass nothing was given that could be right.
TEST(Prior, IsNoStrongerThanItsSizeWhereNothingIsGiven) {
  const auto fitted = [](double given) {
    BlockFits fits = fits_of(1.0, given);
    fits.set_prior(1000.0);
    return fits.fit(number).value[0];
  };
  constexpr double samples = 20000.0;
  EXPECT_NEAR(fitted(given_mass), samples / (samples + 1000.0), 1e-9);
  EXPECT_NEAR(fitted(0.0), samples / (samples + 1.0), 1e-9);
}

TEST(Prior, StrengthIsALinks) {
  Eigen::VectorXd given = Eigen::VectorXd::Zero(30);
  given[10] = 3.0;
  given[21] = 0.5;  // a moment without mass
  const Eigen::VectorXd strength = strength_of_prior(given, 100.0);
  EXPECT_TRUE((strength.segment<10>(10).array() == 100.0).all());
  EXPECT_TRUE((strength.head(10).array() == 1.0).all());
  EXPECT_TRUE((strength.tail(10).array() == 1.0).all());
}

}  // namespace
}  // namespace shapeid::diagnosis
