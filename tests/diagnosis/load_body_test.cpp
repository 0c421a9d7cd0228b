// What a load can be of ten free numbers.
#include "shapeid/diagnosis/load_body.hpp"

#include <gtest/gtest.h>

#include <random>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/diagnosis/planted.hpp"

namespace shapeid::diagnosis {
namespace {

const Box near_link = {Eigen::Vector3d(-1.0, -1.0, -1.0), Eigen::Vector3d(1.0, 1.0, 1.0)};

Eigen::VectorXd point(double mass, const Eigen::Vector3d& place) {
  return mass * unit_parameters(make_point(place, 1.0)).values;
}

/// Normal equations of rows of independent normal numbers, without noise.
BlockFits::Beside exact(const Eigen::VectorXd& numbers, std::uint32_t seed,
                        const std::vector<Eigen::Index>& not_shown = {}) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd rows(50, 10);
  for (double& entry : rows.reshaped()) entry = normal(generator);
  for (const Eigen::Index p : not_shown) rows.col(p).setZero();
  return {rows.transpose() * rows, rows.transpose() * (rows * numbers)};
}

double all_of(const BlockFits::Beside& load, const Eigen::VectorXd& numbers) {
  return numbers.dot(load.normal * numbers);
}

TEST(LoadBody, ABodyLosesNothing) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const Eigen::VectorXd Phi = point(0.7, {0.31, -0.12, 0.83}) + point(0.2, {-0.4, 0.05, 0.3}) +
                                point(0.1, {0.0, 0.6, -0.2});
    const BlockFits::Beside load = exact(Phi, seed);
    const LoadBody body = best_body(load, near_link);
    const double all = all_of(load, Phi);
    // Places are sought until a thousandth of the gain is left, at most ten.
    EXPECT_LT(body.lost, 0.01 * all) << seed;
    EXPECT_NEAR(body.gain + body.lost, all, 1e-9 * all);
    EXPECT_NEAR(body.Phi[0], 1.0, 0.15);
  }
}

TEST(LoadBody, WhatIsNoneLosesMuch) {
  Eigen::VectorXd no_mass = point(1.0, {0.31, -0.12, 0.83});
  no_mass[0] = 0.0;
  const Eigen::VectorXd far = point(1.0, {0.31, -3.0, 0.83});
  for (const Eigen::VectorXd& numbers :
       {no_mass, far, Eigen::VectorXd(-point(1.0, {0.3, 0.2, 0.1}))}) {
    const BlockFits::Beside load = exact(numbers, 7);
    EXPECT_GT(best_body(load, near_link).lost, 0.1 * all_of(load, numbers)) << numbers.transpose();
  }
}

/// At the tip of a long link it is as near as one of a short link at its joint.
TEST(LoadBody, MayBeAnywhereInItsRoom) {
  const Eigen::VectorXd tip = point(1.0, {0.31, -3.0, 0.83});
  const Box of_a_boom = {Eigen::Vector3d(-1.0, -4.0, -1.0), near_link.upper};
  EXPECT_LT(best_body(exact(tip, 7), of_a_boom).lost, 0.01 * all_of(exact(tip, 7), tip));
}

/// On a link that turns about one axis no torque shows the mass: any that the moments need is
/// there.
TEST(LoadBody, AMassThatNoDataShowIsFree) {
  Eigen::VectorXd numbers = point(1.0, {0.5, -0.4, 0.0});
  numbers[0] = 0.0;
  const BlockFits::Beside load = exact(numbers, 3, {0, 3, 5, 6, 8});
  const LoadBody body = best_body(load, near_link);
  EXPECT_LT(body.lost, 0.01 * all_of(load, numbers));
  EXPECT_GT(body.Phi[0], 0.5);
}

TEST(LoadBody, OfNothingNothingIsMade) {
  const BlockFits::Beside load{Eigen::MatrixXd::Zero(10, 10), Eigen::VectorXd::Zero(10)};
  const LoadBody body = best_body(load, near_link);
  EXPECT_EQ(body.gain, 0.0);
  EXPECT_EQ(body.lost, 0.0);
}

/// What is enough is found exactly where the best is enough, and is no better than that.
TEST(LoadBody, MayLoseWhatIsEnough) {
  int found = 0, none = 0, sooner = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    for (const double far : {0.8, 1.2, 1.6, 3.0}) {
      const Eigen::VectorXd Phi = point(0.7, {0.31, -far, 0.83}) + point(0.2, {-0.4, 0.05, 0.3});
      const BlockFits::Beside load = exact(Phi, seed);
      const LoadBody best = best_body(load, near_link);
      for (const MostLost enough :
           {MostLost{0.0, 0.1}, MostLost{1e-3 * all_of(load, Phi), 0.0}, MostLost{0.0, 1e-9}}) {
        const LoadBody body = best_body(load, near_link, enough);
        EXPECT_EQ(enough.allows(body), enough.allows(best)) << seed << " " << far;
        EXPECT_GE(body.lost, best.lost);
        ++(enough.allows(body) ? found : none);
        sooner += body.lost > best.lost ? 1 : 0;
      }
    }
  }
  EXPECT_GT(found, 10);
  EXPECT_GT(none, 10);
  EXPECT_GT(sooner, 10);
}

TEST(LoadBody, HasTenNumbers) {
  EXPECT_FALSE(why_no_load({Eigen::MatrixXd::Zero(10, 10), Eigen::VectorXd::Zero(10)}));
  EXPECT_TRUE(why_no_load({Eigen::MatrixXd::Zero(2, 2), Eigen::VectorXd::Zero(2)}));
  EXPECT_TRUE(why_no_load({Eigen::MatrixXd::Zero(10, 10), Eigen::VectorXd::Zero(9)}));
}

/// Along its only column a term is as large as its number, with the same error between blocks.
TEST(Along, IsTheNumberOfATermOfOne) {
  planted::Planted log(41);
  const std::size_t other = log.add(planted::law("other", 2), log.normal(2));
  const std::size_t k = log.add(planted::law("law"), log.normal(1), 0, 5);
  log.plant(k, planted::one_number(planted::Planted::size_of(9.0)));
  log.add_noise();
  const BlockFits fits = log.fits();
  const std::vector<Term> beside = {log.masses(), log.candidates()[other].term};
  std::vector<Term> all = beside;
  all.push_back(log.candidates()[k].term);
  const Fit fit = fits.fit(all);
  const Eigen::Index last = fit.value.size() - 1;
  const double unit = 0.37;
  const SumWithError size =
      fits.along(beside, log.candidates()[k].term, Eigen::VectorXd::Constant(1, unit));
  // But for the term's own prior, which is wide.
  EXPECT_NEAR(unit * size.sum / fit.value[last], 1.0, 1e-5);
  EXPECT_NEAR(unit * size.error / fit.between_blocks[last], 1.0, 1e-5);
  // Its normal equations say the same.
  const BlockFits::Beside own = fits.beside(beside, log.candidates()[k].term);
  EXPECT_NEAR(own.target[0] / own.normal(0, 0) / fit.value[last], 1.0, 1e-5);
}

}  // namespace
}  // namespace shapeid::diagnosis
