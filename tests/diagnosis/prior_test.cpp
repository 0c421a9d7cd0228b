// How strongly given inertias hold.
#include "shapeid/diagnosis/prior.hpp"

#include <gtest/gtest.h>

namespace shapeid::diagnosis {
namespace {

/// Of one number of usual size one, given as zero, which is `value` in twenty blocks of a thousand
/// samples each; the noise of a sample is one.
double strength_for(double value) {
  constexpr double samples = 1000.0;
  Tally tally;
  tally.inertial = 1;
  tally.width = 2;
  for (int b = 0; b < 20; ++b) {
    Block block;
    block.samples = 1000;
    block.sums.resize(2, 2);
    block.sums << samples, samples * value, samples * value, samples * (value * value + 1.0);
    tally.blocks.push_back(block);
    tally.freedom += samples;
  }
  const Eigen::VectorXd given = Eigen::VectorXd::Zero(1), size = Eigen::VectorXd::Ones(1);
  BlockFits fits(tally, given, size, 8);
  const double strength = choose_prior(fits, {{"number", {0}, {false}, 0}});
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

}  // namespace
}  // namespace shapeid::diagnosis
