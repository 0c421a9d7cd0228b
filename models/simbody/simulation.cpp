#include "shapeid/models/simbody/simulation.hpp"

#include <cmath>
#include <memory>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/world.hpp"

namespace shapeid {
namespace {

void check(const SimulationOptions& options) {
  if (!(options.duration > 0.0)) throw InputError("duration is not positive", "seconds, above 0");
  if (!(options.rate > 0.0)) throw InputError("rate is not positive", "samples a second, above 0");
  if (!(options.accuracy > 0.0 && options.accuracy < 1.0)) {
    throw InputError("accuracy is not between 0 and 1", "a number such as 1e-5");
  }
}

/// Standing still, the ground pressed in as far as the weight needs.
RobotState standing(const Robot& robot, const SimulationOptions& options,
                    const TrotController& controller) {
  const double weight_on_a_foot = 9.81 * robot.mass() / static_cast<double>(robot.contacts.size());
  const double depth = std::pow(weight_on_a_foot / options.ground.stiffness, 2.0 / 3.0);
  RobotState state;
  state.base.translation().z() = options.trot.height - depth;
  state.q = controller.stance();
  state.dq = Eigen::VectorXd::Zero(robot.joint_count());
  return state;
}

bool has_fallen(const RobotState& state, const TrotOptions& trot) {
  constexpr double lowest = 0.5;       // of the wanted height
  constexpr double steepest = 0.7071;  // cosine of 45 degrees
  return state.base.translation().z() < lowest * trot.height ||
         state.base.linear()(2, 2) < steepest;
}

}  // namespace

SimulationReport simulate(const Robot& robot, const SimulationOptions& options,
                          const std::function<void(const SimulatedSample&)>& on_sample) {
  check(options);
  const Robot loaded = options.load ? with_load(robot, *options.load) : robot;
  TrotController controller(robot, options.trot, options.seed);
  const auto carries_at = [&](double time) {
    return time >= options.load_from && time < options.load_until;
  };
  bool carries = carries_at(0.0);
  const auto world_of = [&](const Robot& r) {
    return std::make_unique<World>(r, options.ground, options.disturbance, options.accuracy);
  };
  std::unique_ptr<World> world = world_of(carries ? loaded : robot);
  const RobotState start = standing(carries ? loaded : robot, options, controller);
  world->start(0.0, start, controller.torque(0.0, start));

  // The controller runs at its own pace, a whole number of times a sample.
  constexpr double slowest_control = 500.0;  // Hz
  const auto turns = static_cast<std::size_t>(std::ceil(slowest_control / options.rate));
  const auto samples = static_cast<std::size_t>(std::floor(options.duration * options.rate)) + 1;
  const double period = 1.0 / (options.rate * static_cast<double>(turns));

  // A world counts work from its own start.
  double drive_work = 0.0, ground_work = 0.0;
  SimulationReport report;
  for (std::size_t step = 0; report.samples < samples; ++step) {
    const RobotState state = world->robot_state();
    if (carries != carries_at(world->now())) {
      const double now = world->now();
      const Eigen::VectorXd torque = world->torque();
      const SimulatedSample last = world->sample();
      drive_work += last.drive_work;
      ground_work += last.ground_work;
      carries = !carries;
      world = world_of(carries ? loaded : robot);
      world->start(now, state, torque);
    }
    if (step % turns == 0) {
      SimulatedSample sample = world->sample();
      sample.drive_work += drive_work;
      sample.ground_work += ground_work;
      on_sample(sample);
      ++report.samples;
    }
    report.distance = state.base.translation().head<2>().norm();
    if (has_fallen(state, options.trot)) {
      report.fell_at = world->now();
      break;
    }
    world->advance(static_cast<double>(step + 1) * period, controller.torque(world->now(), state));
  }
  return report;
}

}  // namespace shapeid
