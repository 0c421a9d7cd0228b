// What an accelerometer shows beside gravity and is no motion: it makes masses too small that are
// known by their inertia, and not those that are known by their weight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"

namespace shapeid::diagnosis {
namespace {

using test::Trot;

/// Root mean square of what a model leaves of a log, all rows that count.
double left_by(const Trot& trot, const std::vector<Sample>& samples,
               std::vector<AppliedEffect> effects) {
  const LoopSettings settings = trot.settings();
  const RichModel model{stacked_parameters(trot.robot), std::move(effects), {}};
  return series(trot.robot, settings.rows, model, Recording(samples, Trot::rate), settings.stride)
      .rms()
      .norm();
}

/// The accelerometer moves more than the base does; said with the simulation's own attitude.
TEST(AccelNoise, ItsEquationTakesBackWhatASoftMountAdds) {
  constexpr double n = 0.4;
  const Trot trot;
  std::vector<Sample> samples = trot.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d at_rest = trot.attitude[i].transpose() * Eigen::Vector3d(0, 0, 9.81);
    Eigen::Vector3d& force = samples[i].base_specific_force;
    force = at_rest + (force - at_rest) / (1.0 - n);
  }
  const double clean = left_by(trot, trot.samples, {});
  const double untold = left_by(trot, samples, {});
  const double told = left_by(trot, samples, {test::effect("accel_noise", 0, {n})});
  EXPECT_GT(untold, 5.0 * clean);
  // Down is a second's mean of what the accelerometer shows, turned along by the gyro, and no
  // attitude.
  constexpr double all_but_the_tilt = 0.3;
  EXPECT_LT(std::sqrt(std::max(0.0, told * told - clean * clean)), all_but_the_tilt * untold);
}

/// Shaking as fast as the trot, three times as strong as what the base does.
std::vector<Sample> shaken(std::vector<Sample> samples) {
  constexpr double frequency = 2.0 * M_PI * 6.0, damping = 0.3, size = 3.0;  // rad/s, 1, m/s^2
  Random random(5);
  Eigen::Matrix3Xd shaking(3, std::ssize(samples));
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), speed = place;
  for (Eigen::Index i = 0; i < shaking.cols(); ++i) {
    const Eigen::Vector3d push(random.normal(), random.normal(), random.normal());
    constexpr double dt = 1.0 / Trot::rate;
    speed += dt * (-frequency * (frequency * place + 2.0 * damping * speed) + push);
    place += dt * speed;
    shaking.col(i) = place;
  }
  shaking *= size * std::sqrt(static_cast<double>(shaking.size())) / shaking.norm();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].base_specific_force += shaking.col(static_cast<Eigen::Index>(i));
  }
  return samples;
}

/// The noise is found, and the base's mass.
void expect_mass(const Trot& trot, double truth) {
  const LoopResult result = close_loop(trot.robot, Recording(shaken(trot.samples), Trot::rate),
                                       nullptr, trot.settings_for_base());
  const auto noise = std::find_if(result.found.begin(), result.found.end(), [](const Found& f) {
    return f.effect.effect->id == "accel_noise";
  });
  ASSERT_NE(noise, result.found.end());
  EXPECT_GT(noise->effect.value[0], 0.5);
  EXPECT_GT(result.model.Phi[0], truth / 1.5);
  EXPECT_LT(result.model.Phi[0], truth * 1.5);
  EXPECT_TRUE(std::none_of(result.found.begin(), result.found.end(), [](const Found& f) {
    return f.effect.effect->id == "external_force" && f.name_stands();
  }));
}

/// Constant forces beside the base stood for its weight in this log, and it had no mass at all.
TEST(AccelNoise, DoesNotTakeTheBaseItsMass) {
  const Trot trot;
  expect_mass(trot, trot.robot.links[0].inertia.mass());
}

TEST(AccelNoise, IsBelievedOfABaseThatIsHeavierThanGiven) {
  Trot trot;
  InertialParameters& given = trot.robot.links[0].inertia;
  const double truth = given.mass();
  given.values /= 2.2;
  expect_mass(trot, truth);
}

/// A fifth of what is given was nearer to it than twice as much (a Mini Cheetah on asphalt), and
/// forces stayed in the place of the weight.
TEST(AccelNoise, MassesAreFarFromTheGivenOnesByTheirFactor) {
  const Trot trot;
  const LoopSettings settings = trot.settings_for_base();
  LoopState state(trot.robot, Recording(trot.samples, Trot::rate), nullptr, settings);
  const double given = trot.robot.links[0].inertia.mass();
  const auto off_by = [&](double mass) {
    state.result.model.Phi[0] = mass;
    return state.mass_off_by(0);
  };
  EXPECT_DOUBLE_EQ(off_by(given), 1.0);
  EXPECT_GT(off_by(0.2 * given), off_by(1.92 * given));
  EXPECT_GT(off_by(6.0 * given), off_by(0.2 * given));
  EXPECT_EQ(off_by(0.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(off_by(-0.1 * given), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace shapeid::diagnosis
