// How strong noise of torque is that somebody put there.
#include "shapeid/diagnosis/torque_noise.hpp"

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <cmath>
#include <random>

#include "shapeid/models/segment_filter.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

/// The torque and the accelerometer through the filter of a log; what else is in it stays.
std::vector<Sample> behind(double cutoff, double rate, std::vector<Sample> samples) {
  const Eigen::Index joints = samples[0].tau.size();
  SegmentFilter filter(Smoothing::zero_phase, Butterworth(log_filter_order, cutoff, rate),
                       joints + 3);
  for (const Sample& s : samples) {
    Eigen::VectorXd both(joints + 3);
    both << s.tau, s.base_specific_force;
    filter.push(both);
  }
  filter.finish();
  for (Sample& s : samples) {
    const Eigen::VectorXd both = *filter.next();
    s.tau = both.head(joints);
    s.base_specific_force = both.tail<3>();
  }
  return samples;
}

void add_noise(const Eigen::VectorXd& sigma, std::vector<Sample>& samples) {
  std::mt19937 generator(5);
  std::normal_distribution<double> noise;
  for (Sample& s : samples) {
    for (Eigen::Index j = 0; j < sigma.size(); ++j) s.tau[j] += sigma[j] * noise(generator);
  }
}

constexpr double arm_rate = 100.0, arm_cutoff = 5.0;

/// Some are missing: a pause would spread the torque over all frequencies.
std::vector<Sample> with_pause(std::vector<Sample> samples) {
  constexpr std::size_t first = 2000, last = 2300;
  if (samples.size() > last) samples.erase(samples.begin() + first, samples.begin() + last);
  return samples;
}

struct BothFilters {
  explicit BothFilters(const std::vector<Sample>& samples)
      : smooth(with_pause(behind(arm_cutoff, arm_rate, samples)), arm_rate),
        rough(with_pause(behind(3.0 * arm_cutoff, arm_rate, samples)), arm_rate) {}
  [[nodiscard]] std::vector<double> noise() const {
    return torque_noise({test::arm(), ContactTreatment::ignore, {}},
                        {smooth, rough, arm_cutoff, 3.0 * arm_cutoff},
                        stacked_parameters(test::arm()), 1);
  }
  Recording smooth, rough;
};

/// The torque itself is a thousand times as strong as the noise.
std::vector<Sample> motion(double seconds) { return test::record({{}, seconds, 0.0}).samples(); }

constexpr double minute = 60.0;

/// Of n frequencies the mean power of noise has a standard deviation of 1 / sqrt n.
double four_deviations(double seconds, double cutoff) {
  return 4.0 / std::sqrt(0.5 * cutoff * seconds);
}

TEST(TorqueNoise, IsWhatWasAddedToEachJoint) {
  constexpr double seconds = 4.0 * minute;
  std::vector<Sample> samples = motion(seconds);
  const Eigen::Vector3d sigma(0.02, 0.05, 0.11);
  add_noise(sigma, samples);
  const std::vector<double> noise = BothFilters(samples).noise();
  ASSERT_EQ(noise.size(), 3U);
  for (std::size_t j = 0; j < 3; ++j) {
    const double added = std::pow(sigma[static_cast<Eigen::Index>(j)], 2) / arm_rate;
    EXPECT_NEAR(noise[j] / added, 1.0, four_deviations(seconds, arm_cutoff)) << j;
  }
}

/// Dry friction holds it at rest against any torque: what it has there is not asked.
TEST(TorqueNoise, OfAJointThatRestsIsThatOfTheRest) {
  constexpr Eigen::Index resting = 1;
  constexpr double moves_after = 0.5 * minute, sigma = 0.05;
  std::vector<Sample> samples = test::record({{}, minute, 0.0}, [](std::vector<Sample>& all) {
                                  for (Sample& s : all) {
                                    if (s.time < moves_after)
                                      s.q[resting] = s.dq[resting] = s.ddq[resting] = 0.0;
                                  }
                                }).samples();
  std::mt19937 generator(9);
  std::normal_distribution<double> noise;
  for (Sample& s : samples)
    s.tau[resting] += (s.time < moves_after ? 0.0 : sigma) * noise(generator);
  EXPECT_NEAR(BothFilters(samples).noise()[resting] / (sigma * sigma / arm_rate), 1.0,
              four_deviations(minute - moves_after, arm_cutoff));
}

/// What the robot does is slower than the filter.
TEST(TorqueNoise, IsNextToNothingWithoutAny) {
  for (const double n : BothFilters(motion(minute)).noise())
    EXPECT_LT(n, 1e-3 * 0.02 * 0.02 / arm_rate);
}

TEST(TorqueNoise, IsUnknownOfAShortLog) {
  const std::vector<Sample> samples = motion(2.0);
  for (const double n : BothFilters(samples).noise()) EXPECT_TRUE(std::isnan(n));
}

TEST(TorqueNoise, IsUnknownWhereTheRoughLogHasNoSamples) {
  BothFilters both(motion(minute));
  both.rough = Recording({}, arm_rate);
  for (const double n : both.noise()) EXPECT_TRUE(std::isnan(n));
}

/// The same noise at all joints of a trot, or of its accelerometer: what contact forces could
/// explain of it is gone, and that of the accelerometer is what the links make of it.
void expect_that_beyond_contacts(double of_torque, double of_accelerometer) {
  const test::Trot trot;
  const Eigen::VectorXd Phi = stacked_parameters(trot.robot);
  constexpr double of_filter = 15.0;
  std::vector<Sample> quiet = trot.samples, noisy = quiet;
  add_noise(Eigen::VectorXd::Constant(trot.robot.joint_count(), of_torque), noisy);
  std::mt19937 generator(6);
  std::normal_distribution<double> noise_of_reading;
  // The noise alone: contacts' forces change the torque faster than any filter.
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    noisy[i].tau -= quiet[i].tau;
    for (double& s : noisy[i].base_specific_force) {
      s = of_accelerometer * noise_of_reading(generator);
    }
  }
  const Recording smooth(behind(of_filter, test::Trot::rate, noisy), test::Trot::rate);
  const Recording rough(behind(3.0 * of_filter, test::Trot::rate, noisy), test::Trot::rate);
  const Viewer viewer(trot.robot, ContactTreatment::project, {});
  const std::vector<double> noise =
      torque_noise(viewer, {smooth, rough, of_filter, 3.0 * of_filter}, Phi, 4);

  const auto usable = smooth.usable(20);
  const Eigen::Index n = trot.robot.joint_count();
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(n);
  for (const std::size_t i : usable) {
    const Eigen::MatrixXd JT = viewer.view(smooth, i).J.transpose();
    const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(JT.rows(), JT.rows()) -
                              JT * JT.completeOrthogonalDecomposition().pseudoInverse();
    expected += std::pow(of_torque, 2) * P.bottomRightCorner(n, n).rowwise().squaredNorm();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Sample pushed = smooth[i];
      pushed.base_specific_force[axis] += of_accelerometer;
      const Eigen::VectorXd more =
          (reference::regressor(trot.robot, pushed) - reference::regressor(trot.robot, smooth[i])) *
          Phi;
      expected += (P * more).tail(n).cwiseAbs2();
    }
  }
  expected /= test::Trot::rate * static_cast<double>(usable.size());
  for (std::size_t j = 0; j < noise.size(); ++j) {
    EXPECT_NEAR(noise[j] / expected[static_cast<Eigen::Index>(j)], 1.0,
                four_deviations(smooth.duration(), of_filter))
        << j;
  }
}

TEST(TorqueNoise, IsThatBeyondContactForces) { expect_that_beyond_contacts(0.1, 0.0); }

TEST(TorqueNoise, HoldsThatOfTheAccelerometer) { expect_that_beyond_contacts(0.05, 0.05); }

}  // namespace
}  // namespace shapeid::diagnosis
