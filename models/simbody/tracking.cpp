#include "shapeid/models/simbody/tracking.hpp"

#include <memory>
#include <vector>

#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/models/simbody/two_pi.hpp"
#include "shapeid/models/simbody/world.hpp"

namespace shapeid {

void simulate_tracking(const Robot& robot, const TrackingOptions& options,
                       const std::function<void(const Sample&)>& on_sample) {
  std::vector<Sample> wanted;
  simulate_joint_trajectory(robot, options.wanted, [&](const Sample& s) { wanted.push_back(s); });

  // A critically damped spring of the bandwidth, in front of the inertia that the joints have
  // there.
  const double pole = two_pi * options.bandwidth;
  const SimbodyRobot known(robot);
  const auto torque = [&](const Sample& w, const RobotState& state) -> Eigen::VectorXd {
    return w.tau + known.mass_matrix(state.q) *
                       (pole * pole * (w.q - state.q) + 2.0 * pole * (w.dq - state.dq));
  };

  const Robot loaded = options.load ? with_load(robot, *options.load) : robot;
  bool carries = options.load_from <= 0.0;
  const auto world_of = [&](const Robot& r) {
    return std::make_unique<World>(r, Ground{}, options.disturbance, options.accuracy);
  };
  std::unique_ptr<World> world = world_of(carries ? loaded : robot);
  RobotState start;
  start.q = wanted.front().q;
  start.dq = wanted.front().dq;
  world->start(0.0, start, wanted.front().tau);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const RobotState state = world->robot_state();
    if (!carries && world->now() >= options.load_from) {
      const double now = world->now();
      const Eigen::VectorXd held = world->torque();
      carries = true;
      world = world_of(loaded);
      world->start(now, state, held);
    }
    on_sample(world->sample().sample);
    if (i + 1 < wanted.size()) world->advance(wanted[i + 1].time, torque(wanted[i], state));
  }
}

}  // namespace shapeid
