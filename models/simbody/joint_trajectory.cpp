#include "shapeid/models/simbody/joint_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/models/simbody/two_pi.hpp"

namespace shapeid {
namespace {

/// centre + sum over k of amplitude_k sin(k w t + phase_k)
struct MultiSine {
  double centre = 0.0, w = 0.0;
  std::vector<double> amplitude, phase;

  /// Writes position, velocity and acceleration of joint j into the sample.
  void evaluate(double time, Eigen::Index j, Sample& sample) const;
};

void MultiSine::evaluate(double time, Eigen::Index j, Sample& sample) const {
  sample.q[j] = centre;
  sample.dq[j] = 0.0;
  sample.ddq[j] = 0.0;
  for (std::size_t i = 0; i < amplitude.size(); ++i) {
    const double rate = static_cast<double>(i + 1) * w;
    const double angle = rate * time + phase[i];
    sample.q[j] += amplitude[i] * std::sin(angle);
    sample.dq[j] += amplitude[i] * rate * std::cos(angle);
    sample.ddq[j] -= amplitude[i] * rate * rate * std::sin(angle);
  }
}

MultiSine draw(const Joint& joint, const JointTrajectoryOptions& options, Random& random) {
  MultiSine motion;
  motion.w = two_pi * options.frequency;
  double sum = 0.0;
  double rate_sum = 0.0;
  for (int k = 1; k <= options.harmonics; ++k) {
    motion.amplitude.push_back(random.uniform(0.3, 1.0) / k);
    motion.phase.push_back(random.uniform(0.0, two_pi));
    sum += motion.amplitude.back();
    rate_sum += k * motion.w * motion.amplitude.back();
  }
  const double unlimited = joint.kind == JointKind::prismatic ? 0.2 : 1.0;
  double half_range = unlimited;
  if (joint.kind != JointKind::continuous && std::isfinite(joint.upper - joint.lower)) {
    motion.centre = 0.5 * (joint.lower + joint.upper);
    half_range = 0.5 * (joint.upper - joint.lower);
  }
  // The sums bound the motion whatever the phases are.
  const double scale = options.reach * std::min(half_range / sum, std::isfinite(joint.velocity)
                                                                      ? joint.velocity / rate_sum
                                                                      : half_range / sum);
  for (double& a : motion.amplitude) a *= scale;
  return motion;
}

void check(const Robot& robot, const JointTrajectoryOptions& options) {
  if (robot.root != Root::fixed) {
    throw InputError("a joint trajectory needs a base that does not move", "a fixed root");
  }
  if (!(options.duration > 0.0 && options.rate > 0.0 && options.frequency > 0.0)) {
    throw InputError("duration, rate or frequency is not positive", "numbers above 0");
  }
  if (options.harmonics < 1) throw InputError("no harmonics", "at least one");
  if (!(options.reach > 0.0 && options.reach <= 1.0)) {
    throw InputError("reach is not within (0, 1]", "a share such as 0.7");
  }
}

}  // namespace

void simulate_joint_trajectory(const Robot& robot, const JointTrajectoryOptions& options,
                               const std::function<void(const Sample&)>& on_sample) {
  check(robot, options);
  const SimbodyRobot simbody(robot);
  Random random(options.seed);
  std::vector<MultiSine> motions;
  motions.reserve(static_cast<std::size_t>(robot.joint_count()));
  for (int j = 0; j < robot.joint_count(); ++j) {
    motions.push_back(draw(robot.joint(j), options, random));
  }
  const auto samples = static_cast<std::size_t>(std::floor(options.duration * options.rate)) + 1;
  for (std::size_t i = 0; i < samples; ++i) {
    Sample s;
    s.time = static_cast<double>(i) / options.rate;
    s.q.resize(robot.joint_count());
    s.dq.resize(robot.joint_count());
    s.ddq.resize(robot.joint_count());
    for (int j = 0; j < robot.joint_count(); ++j) {
      motions[static_cast<std::size_t>(j)].evaluate(s.time, j, s);
    }
    s.tau = simbody.inverse_dynamics(s);
    on_sample(s);
  }
}

}  // namespace shapeid
