// How strongly given inertias hold.
#include "shapeid/diagnosis/prior.hpp"

#include <gtest/gtest.h>

namespace shapeid::diagnosis {
namespace {

/// One number of usual size one, which is `value` more than given in twenty blocks of a thousand
/// samples each; the noise of a sample is one.
BlockFits fits_of(double value) {
  constexpr double samples = 1000.0, given = 2.0;
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (int b = 0; b < 20; ++b) {
    Block block;
    block.samples = 1000;
    block.sums.resize(2, 2);
    const double force = given + value;
    block.sums << samples, samples * force, samples * force, samples * (force * force + 1.0);
    block.freedom = samples;
    tally.blocks.push_back(block);
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

}  // namespace
}  // namespace shapeid::diagnosis
