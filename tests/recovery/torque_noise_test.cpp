// With noise on the torques alone least squares has no bias, and its error falls as 1/sqrt(N).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shapeid/models/simbody/random.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"

namespace shapeid {
namespace {

using reference::Window;
using test::bundled_quadruped;
using test::Quadruped;
using test::trot;

constexpr std::size_t seeds = 24;

/// D^-1 (Phi - Phi*) of the base, from every `stride`-th sample, with noise of `sigma` N m.
Eigen::VectorXd error(const Quadruped& quadruped, const std::vector<SimulatedSample>& motion,
                      std::size_t stride, double sigma, Random& random) {
  const Robot& robot = quadruped.robot;
  Window window(robot, quadruped.base, ContactTreatment::project,
                Eigen::VectorXd::Ones(robot.dof()));
  for (std::size_t i = 0; i < motion.size(); i += stride) {
    Sample noisy = motion[i].sample;
    for (double& tau : noisy.tau) tau += sigma * random.normal();
    window.add(noisy);
  }
  const MassSolution found = reference::solve_masses(window.problem(quadruped.base));
  const Eigen::VectorXd truth = stacked_parameters(robot).head<10>();
  return (found.Phi - truth).cwiseQuotient(reference::natural_sizes(quadruped.base, truth[0]));
}

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::ArrayXd u = Eigen::Map<const Eigen::ArrayXd>(x.data(), n).log();
  const Eigen::ArrayXd v = Eigen::Map<const Eigen::ArrayXd>(y.data(), n).log();
  u -= u.mean();
  return (u * v).sum() / u.square().sum();
}

// Every 8th, 4th, 2nd and each sample of the same motion: what it excites stays the same while N
// grows eightfold (a longer log would also excite differently). The root mean square over 24 seeds
// of an error with at least three independent directions scatters by 1 / sqrt(2 x 24 x 3) = 8
// percent; with four lengths evenly spread over log 8 the slope then scatters by
// 0.08 / sqrt(sum (log N - mean)^2) = 0.08 / 1.55 = 0.054. The bound is three of these.
TEST(TorqueNoise, ErrorFallsAsOneOverTheRootOfTheSamples) {
  const Quadruped quadruped = bundled_quadruped();
  const auto motion = trot(quadruped.robot, {8.0, 100.0, 1, {}});
  const double sigma = quadruped.notes.noise_sigma.at("tau");
  Random random(20240611);
  std::vector<double> samples, rms;
  for (const std::size_t stride : {8u, 4u, 2u, 1u}) {
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(10), sum = squares;
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      const Eigen::VectorXd e = error(quadruped, motion, stride, sigma, random);
      squares += e.cwiseAbs2();
      sum += e;
    }
    const std::size_t count = motion.size() / stride;
    samples.push_back(static_cast<double>(count));
    rms.push_back(std::sqrt(squares.sum() / seeds));
    fmt::print(
        "torque noise {} N m, N = {:3.0f}: error {:.4f} of natural sizes, times sqrt(N) "
        "{:.3f}, mean error {:.4f}\n",
        sigma, samples.back(), rms.back(), rms.back() * std::sqrt(samples.back()),
        sum.norm() / seeds);
    // No bias: the mean of 24 errors is as far from zero as chance allows (three standard errors).
    EXPECT_LT(sum.norm() / seeds, 3.0 * rms.back() / std::sqrt(seeds));
  }
  const double exponent = slope(samples, rms);
  fmt::print("exponent {:.3f}\n", exponent);
  EXPECT_GT(exponent, -0.65);
  EXPECT_LT(exponent, -0.35);
}

}  // namespace
}  // namespace shapeid
