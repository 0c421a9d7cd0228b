#include "shapeid/models/simbody/simulation.hpp"

#include <cmath>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/forces.hpp"
#include "shapeid/models/simbody/multibody.hpp"

namespace shapeid {
namespace {

void check(const SimulationOptions& options) {
  if (!(options.duration > 0.0)) throw InputError("duration is not positive", "seconds, above 0");
  if (!(options.rate > 0.0)) throw InputError("rate is not positive", "samples a second, above 0");
  if (!(options.accuracy > 0.0 && options.accuracy < 1.0)) {
    throw InputError("accuracy is not between 0 and 1", "a number such as 1e-5");
  }
}

/// The robot, its drives and the ground as one system that steps through time.
class World {
 public:
  World(const Robot& robot, const SimulationOptions& options)
      : robot_(robot),
        multibody_(robot),
        drives_(new DriveForce(multibody_)),
        ground_(new GroundForce(multibody_, robot, options.ground)),
        // The force subsystem owns the elements from here on.
        drive_handle_(multibody_.forces, drives_),
        ground_handle_(multibody_.forces, ground_),
        integrator_(multibody_.system) {
    integrator_.setAccuracy(options.accuracy);
    integrator_.setAllowInterpolation(false);  // every sample is a state that was integrated to
  }

  /// With these torques (N m, n) from the first instant on.
  void start(const RobotState& robot_state, const Eigen::VectorXd& torque) {
    drives_->hold(torque);
    SimTK::State state = multibody_.system.realizeTopology();
    multibody_.set(state, robot_state);
    integrator_.initialize(state);
    realize();
  }

  /// Torques go straight to `command` until the instant `to` (s), and the world moves there.
  void advance(double to, const Eigen::VectorXd& command) {
    drives_->ramp(now(), to, command);
    while (now() < to) integrator_.stepTo(to);
    realize();
  }

  [[nodiscard]] double now() const { return integrator_.getTime(); }
  [[nodiscard]] RobotState robot_state() const { return multibody_.get(integrator_.getState()); }
  [[nodiscard]] SimulatedSample sample() const;

 private:
  void realize() { multibody_.system.realize(integrator_.getState(), SimTK::Stage::Acceleration); }

  const Robot& robot_;
  Multibody multibody_;
  DriveForce* drives_;
  GroundForce* ground_;
  SimTK::Force::Custom drive_handle_, ground_handle_;
  SimTK::RungeKuttaMersonIntegrator integrator_;
};

SimulatedSample World::sample() const {
  const SimTK::State& state = integrator_.getState();
  const SimTK::MobilizedBody& base = multibody_.body(0);
  SimulatedSample result;
  result.state = robot_state();
  result.drive_work = drives_->work(state);
  result.ground_work = ground_->work(state);

  const Eigen::Matrix3d to_base = result.state.base.linear().transpose();
  const Eigen::Vector3d g = to_eigen(multibody_.gravity.getGravityVector(state));
  Sample& s = result.sample;
  s.time = state.getTime();
  s.base_angular_velocity = result.state.base_angular_velocity;
  s.base_angular_acceleration = to_base * to_eigen(base.getBodyAngularAcceleration(state));
  s.base_specific_force = to_base * (to_eigen(base.getBodyOriginAcceleration(state)) - g);
  s.q = result.state.q;
  s.dq = result.state.dq;
  s.ddq.resize(robot_.joint_count());
  for (int j = 0; j < robot_.joint_count(); ++j) {
    s.ddq[j] = multibody_.body(j + 1).getOneUDot(state, 0);
  }
  s.tau = drives_->torque(s.time);
  for (std::size_t c = 0; c < robot_.contacts.size(); ++c) {
    const Eigen::Vector3d force = to_eigen(ground_->force(state, c));
    s.in_contact.push_back(force.z() > 0.0);
    s.contact_force.emplace_back(to_base * force);
  }
  return result;
}

/// Standing still, the ground pressed in as far as the weight needs.
RobotState standing(const Robot& robot, const SimulationOptions& options,
                    const TrotController& controller) {
  double mass = 0.0;
  for (const Link& link : robot.links) mass += link.inertia.mass();
  const double weight_on_a_foot = 9.81 * mass / static_cast<double>(robot.contacts.size());
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
  World world(loaded, options);
  const RobotState start = standing(loaded, options, controller);
  world.start(start, controller.torque(0.0, start));

  // The controller runs at its own pace, a whole number of times a sample.
  constexpr double slowest_control = 500.0;  // Hz
  const auto turns = static_cast<std::size_t>(std::ceil(slowest_control / options.rate));
  const auto samples = static_cast<std::size_t>(std::floor(options.duration * options.rate)) + 1;
  const double period = 1.0 / (options.rate * static_cast<double>(turns));

  SimulationReport report;
  for (std::size_t step = 0; report.samples < samples; ++step) {
    const RobotState state = world.robot_state();
    if (step % turns == 0) {
      on_sample(world.sample());
      ++report.samples;
    }
    report.distance = state.base.translation().head<2>().norm();
    if (has_fallen(state, options.trot)) {
      report.fell_at = world.now();
      break;
    }
    world.advance(static_cast<double>(step + 1) * period, controller.torque(world.now(), state));
  }
  return report;
}

}  // namespace shapeid
