// What is usually fitted: exact where the truth is of that kind, and blind to all else.
#include "shapeid/diagnosis/usual.hpp"

#include <gtest/gtest.h>

#include "shapeid/diagnosis/series.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::record;

constexpr double noise = 0.02;

/// Root mean square of each joint on another log of the same robot, over the noise.
Eigen::VectorXd left_on_another_log(const std::vector<AppliedEffect>& truth) {
  const LoopSettings settings = arm_settings();
  LoopResult loop;
  loop.weight = Eigen::VectorXd::Ones(3);
  const RichModel model = usual_model(arm(), record({truth, 20.0, noise, 1}), settings, loop);
  EXPECT_EQ(model.effects.size(), 12U) << "four at each of three joints";
  const Recording other = record({truth, 20.0, noise, 2});
  return series(arm(), settings.rows, model, other, 1).rms() / noise;
}

TEST(Usual, LeavesNoiseOfWhatIsOfThatKind) {
  // A negative friction, too: no sign is asked for.
  const Eigen::VectorXd left = left_on_another_log(
      {effect("viscous_friction", 0, {0.4}), effect("viscous_friction", 2, {-0.2}),
       effect("torque_offset", 1, {0.3}), effect("rotor_inertia", 1, {0.2})});
  for (Eigen::Index j = 0; j < 3; ++j) {
    EXPECT_GT(left[j], 0.9) << j;
    EXPECT_LT(left[j], 1.1) << j;
  }
}

TEST(Usual, DoesNotSeeWhatIsNot) {
  const Eigen::VectorXd left = left_on_another_log({effect("torque_delay", 0, {0.02})});
  EXPECT_GT(left.maxCoeff(), 2.0);
}

}  // namespace
}  // namespace shapeid::diagnosis
