// How strong a signal is at each frequency.
#include "shapeid/diagnosis/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr double first_time = 3.25;  // s: a log need not begin at zero

std::vector<double> evenly(std::size_t count, double step) {
  std::vector<double> time;
  for (std::size_t i = 0; i < count; ++i)
    time.push_back(first_time + step * static_cast<double>(i));
  return time;
}

Eigen::VectorXd wave(const std::vector<double>& time, double frequency, double phase) {
  Eigen::VectorXd y(std::ssize(time));
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    y[i] = std::sqrt(2.0) *
           std::cos(2.0 * std::numbers::pi * frequency * time[static_cast<std::size_t>(i)] + phase);
  }
  return y;
}

/// Five whole periods in 2 s, of unit variance: half the samples' number at 2.5 Hz, whatever the
/// phase, and next to nothing a period further.
TEST(Spectrum, OfAWaveIsAtItsFrequency) {
  const std::vector<double> time = evenly(401, 0.005);
  for (const double phase : {0.0, 1.0, 2.5}) {
    const Spectrum s = spectrum(time, wave(time, 2.5, phase), 20.0);
    EXPECT_EQ(s.step, 0.5);
    EXPECT_EQ(s.every, 1.0);
    ASSERT_EQ(s.power.size(), 39U) << "0.5 to 19.5 Hz";
    const std::size_t place = s.at(2.5);
    EXPECT_EQ(place, 4U);
    EXPECT_NEAR(s.power[place], 401.0 / 2.0, 2.0);  // one sample more than whole periods
    for (std::size_t k = 0; k < s.power.size(); ++k) {
      if (k != place) {
        EXPECT_LT(s.power[k], 0.02) << k;
      }
    }
  }
}

TEST(Spectrum, OfAWaveInGapsIsAtItsFrequency) {
  std::vector<double> time;
  for (const double t : evenly(2000, 0.0025)) {
    const double into = std::fmod(t, 1.0);
    if (into < 0.35 || into > 0.6) time.push_back(t);
  }
  const Spectrum s = spectrum(time, wave(time, 7.0, 0.4), 20.0);
  const auto most = std::max_element(s.power.begin(), s.power.end()) - s.power.begin();
  EXPECT_NEAR(static_cast<double>(most + 1) * s.step, 7.0, s.step);
}

/// Parseval: over all frequencies up to half the rate the mean power is the variance.
TEST(Spectrum, OfNoiseOfUnitVarianceIsOneOnAverage) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const std::vector<double> time = evenly(3001, 0.01);
  Eigen::VectorXd y(3001);
  for (double& value : y) value = normal(random);
  y.array() -= y.mean();
  y /= std::sqrt(y.squaredNorm() / 3001.0);
  const Spectrum s = spectrum(time, y, 50.0);
  EXPECT_NEAR(s.mean(0, s.power.size()), 1.0, 2e-3);  // one period more than samples have
  EXPECT_NEAR(spectrum(time, 3.0 * y, 50.0).mean(0, s.power.size()), 9.0, 2e-2);
}

TEST(Spectrum, PlacesOfFrequencies) {
  Spectrum s;
  s.step = 0.5;
  s.power = {1.0, 2.0, 4.0, 8.0};
  EXPECT_EQ(s.at(0.0), 0U);
  EXPECT_EQ(s.at(0.5), 0U);
  EXPECT_EQ(s.at(1.0), 1U);
  EXPECT_EQ(s.at(1.4), 1U) << "the last that is no larger";
  EXPECT_EQ(s.at(2.0), 3U);
  EXPECT_EQ(s.at(100.0), 4U) << "beyond the last";
  EXPECT_EQ(s.mean(1, 3), 3.0);
  EXPECT_EQ(s.mean(3, 4), 8.0);
}

TEST(Spectrum, OfOneMomentIsEmpty) {
  const Spectrum s = spectrum({2.0, 2.0}, Eigen::Vector2d(1.0, 2.0), 10.0);
  EXPECT_TRUE(s.power.empty());
}

TEST(UsualStep, IsTheMiddleOneWhateverGapsThereAre) {
  EXPECT_EQ(usual_step({0.0, 0.5, 1.0, 9.0, 9.5, 10.0}), 0.5);
  EXPECT_EQ(usual_step({0.0, 2.0}), 2.0);
  EXPECT_EQ(usual_step({0.0, 1.0, 3.0, 6.0}), 2.0);
}

}  // namespace
}  // namespace shapeid::diagnosis
