#include "shapeid/models/simbody/trot_controller.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/random.hpp"

namespace shapeid {
namespace {

constexpr double pi = 3.141592653589793;
constexpr double gravity = 9.81;

// Gains: a body of 13 kg and about 0.15, 0.4, 0.4 kg m^2 answers with 1.5 to 2 Hz, well damped.
const Eigen::Vector3d velocity_gain(6.0, 6.0, 14.0);    // 1/s: N per kg and m/s
constexpr double height_gain = 120.0;                   // 1/s^2: N per kg and m
const Eigen::Vector3d attitude_gain(40.0, 60.0, 40.0);  // N m / rad
const Eigen::Vector3d turn_gain(4.0, 6.0, 4.0);         // N m s / rad
constexpr double swing_stiffness = 900.0;               // N / m
constexpr double swing_damping = 22.0;                  // N s / m
constexpr double raibert_gain = 0.1;                    // s
constexpr double press_down = 0.004;   // m: a swing aims below the ground, so that it does land
constexpr double lightest_step = 4.0;  // N: a standing foot pushes at least so much

double yaw_of(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

Eigen::Matrix3d about_z(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& r) {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/// In base axes, m, with the joints at q.
Eigen::Vector3d centre_of_mass(const Robot& robot, const Eigen::VectorXd& q) {
  std::vector<Eigen::Isometry3d> frames = {Eigen::Isometry3d::Identity()};
  Eigen::Vector3d moment = robot.links[0].inertia.first_moment();
  double mass = robot.links[0].inertia.mass();
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Link& link = robot.links[static_cast<std::size_t>(j) + 1];
    frames.push_back(frames[static_cast<std::size_t>(link.parent)] * link.joint.placement *
                     Eigen::AngleAxisd(q[j], link.joint.axis));
    moment += link.inertia.mass() * (frames.back() * link.inertia.centre_of_mass());
    mass += link.inertia.mass();
  }
  return moment / mass;
}

/// Into the friction cone, with a force that pushes.
Eigen::Vector3d limited(const Eigen::Vector3d& force, double friction) {
  Eigen::Vector3d f = force;
  f.z() = std::max(f.z(), lightest_step);
  const double along = f.head<2>().norm();
  if (along > friction * f.z()) f.head<2>() *= friction * f.z() / along;
  return f;
}

}  // namespace

double TrotController::Wave::operator()(double time) const {
  return 0.5 *
         (std::sin(frequency[0] * time + phase[0]) + std::sin(frequency[1] * time + phase[1]));
}

TrotController::TrotController(const Robot& robot, const TrotOptions& options, std::uint64_t seed)
    : robot_(&robot), options_(options), stance_(Eigen::VectorXd::Zero(robot.joint_count())) {
  if (robot.root != Root::floating || robot.contacts.size() != 4) {
    throw InputError("robot " + robot.name + " cannot trot", "a floating base and four feet");
  }
  for (const Contact& contact : robot.contacts) {
    Leg leg(robot, contact);
    const Eigen::Vector3d straight = leg.position(Eigen::Vector3d::Zero());
    const Eigen::Vector3d home(straight.x(), straight.y(), -options.height);
    // Diagonal legs move together.
    const double offset = home.x() * home.y() > 0.0 ? 0.0 : 0.5;
    feet_.push_back({leg, home, offset});
  }
  stand_up();
  // The bent legs take the centre of mass off the middle of the feet: they follow it.
  mass_ = robot.mass();
  centre_ = centre_of_mass(robot, stance_);
  for (Foot& foot : feet_) foot.home.head<2>() += centre_.head<2>();
  stand_up();

  Random random(seed);
  for (Wave& wave : waves_) {
    wave.frequency = {2.0 * pi * random.uniform(0.25, 0.6), 2.0 * pi * random.uniform(0.7, 1.3)};
    wave.phase = {random.uniform(0.0, 2.0 * pi), random.uniform(0.0, 2.0 * pi)};
  }
}

void TrotController::stand_up() {
  const Eigen::Vector3d bent(0.0, 0.75, -1.5);  // knees behind the line from hip to foot
  for (const Foot& foot : feet_) {
    const Eigen::Vector3d q = foot.leg.reach(foot.home, bent);
    for (int i = 0; i < 3; ++i) stance_[foot.leg.joints()[static_cast<std::size_t>(i)]] = q[i];
  }
}

TrotController::Wanted TrotController::wanted(double time, double yaw) const {
  // Everything starts gently after standing up.
  const double gain = std::clamp((time - options_.stand) / 1.0, 0.0, 1.0);
  const auto vary = [&](int i, double amplitude) {
    return gain * amplitude * waves_[static_cast<std::size_t>(i)](time);
  };
  Wanted w;
  w.velocity = about_z(yaw) * Eigen::Vector3d(gain * options_.speed + vary(0, options_.vary_speed),
                                              vary(1, options_.vary_side), 0.0);
  w.turn = vary(2, options_.vary_turn);
  w.height = options_.height + vary(3, options_.vary_height);
  w.roll = vary(4, options_.vary_tilt);
  w.pitch = vary(5, options_.vary_tilt);
  return w;
}

std::vector<Eigen::Vector3d> TrotController::stance_forces(const RobotState& state,
                                                           const Wanted& wanted) const {
  const Eigen::Matrix3d R = state.base.linear();
  const Eigen::Vector3d velocity = R * state.base_linear_velocity;
  const Eigen::Vector3d omega = R * state.base_angular_velocity;

  Eigen::Vector3d acceleration = velocity_gain.cwiseProduct(wanted.velocity - velocity);
  acceleration.z() += height_gain * (wanted.height - state.base.translation().z()) + gravity;

  const Eigen::Matrix3d R_wanted =
      about_z(heading_) * Eigen::AngleAxisd(wanted.pitch, Eigen::Vector3d::UnitY()).matrix() *
      Eigen::AngleAxisd(wanted.roll, Eigen::Vector3d::UnitX()).matrix();
  const Eigen::AngleAxisd turn(R.transpose() * R_wanted);  // still to be turned, base axes
  const Eigen::Vector3d omega_wanted(0.0, 0.0, wanted.turn);
  const Eigen::Vector3d moment =
      R * (attitude_gain.cwiseProduct(turn.angle() * turn.axis()) +
           turn_gain.cwiseProduct(R.transpose() * (omega_wanted - omega)));

  std::vector<std::size_t> standing;
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    if (feet_[i].standing) standing.push_back(i);
  }
  const auto columns = static_cast<Eigen::Index>(3 * standing.size());
  Eigen::MatrixXd A(6, columns);
  for (std::size_t k = 0; k < standing.size(); ++k) {
    const Leg& leg = feet_[standing[k]].leg;
    const auto column = static_cast<Eigen::Index>(3 * k);
    A.block<3, 3>(0, column).setIdentity();
    A.block<3, 3>(3, column) = cross_matrix(R * (leg.position(leg.own(state.q)) - centre_));
  }
  Eigen::VectorXd wrench(6);
  wrench << mass_ * acceleration, moment;
  // Moments count more than forces (1 N m against 0.2 N), small forces more than large ones.
  Eigen::VectorXd weight(6);
  weight << 1, 1, 1, 25, 25, 25;
  constexpr double smallness = 1e-3;
  const Eigen::MatrixXd normal = A.transpose() * weight.asDiagonal() * A +
                                 smallness * Eigen::MatrixXd::Identity(columns, columns);
  const Eigen::VectorXd f = normal.ldlt().solve(A.transpose() * weight.asDiagonal() * wrench);

  std::vector<Eigen::Vector3d> forces(feet_.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < standing.size(); ++k) {
    forces[standing[k]] =
        limited(f.segment<3>(static_cast<Eigen::Index>(3 * k)), options_.friction);
  }
  return forces;
}

Eigen::Vector3d TrotController::swing_force(const Foot& foot, double progress, double remaining,
                                            const RobotState& state, const Wanted& wanted) const {
  const Eigen::Matrix3d R = state.base.linear();
  const Eigen::Matrix3d level = about_z(yaw_of(R));
  const Eigen::Vector3d velocity = R * state.base_linear_velocity;
  const double stance_time = options_.duty * options_.period;
  const double swing_time = options_.period - stance_time;

  // Raibert: land below where the hip will be, half a stance ahead, and further out if too fast.
  const Eigen::Vector3d hip =
      state.base.translation() + velocity * remaining +
      level * about_z(wanted.turn * (remaining + 0.5 * stance_time)) * foot.home;
  Eigen::Vector3d target =
      hip + 0.5 * stance_time * velocity + raibert_gain * (velocity - wanted.velocity);
  target.z() = -press_down;

  // A cycloid along, a raised cosine up: both start and end at rest.
  const double angle = 2.0 * pi * progress;
  const double along = progress - std::sin(angle) / (2.0 * pi);
  const double along_rate = (1.0 - std::cos(angle)) / swing_time;
  const double up = 0.5 * (1.0 - std::cos(angle));
  const double up_rate = pi * std::sin(angle) / swing_time;
  const Eigen::Vector3d way = target - foot.lifted;
  const Eigen::Vector3d z = options_.clearance * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d place_wanted = foot.lifted + along * way + up * z;
  const Eigen::Vector3d rate_wanted = along_rate * way + up_rate * z;

  const Eigen::Vector3d q = foot.leg.own(state.q);
  const Eigen::Vector3d in_base = foot.leg.position(q);
  const Eigen::Vector3d place = state.base * in_base;
  const Eigen::Vector3d rate =
      R * (state.base_linear_velocity + state.base_angular_velocity.cross(in_base) +
           foot.leg.jacobian(q) * foot.leg.own(state.dq));
  return swing_stiffness * (place_wanted - place) + swing_damping * (rate_wanted - rate);
}

Eigen::VectorXd TrotController::torque(double time, const RobotState& state) {
  const Eigen::Matrix3d R = state.base.linear();
  const double yaw = yaw_of(R);
  const Wanted w = wanted(time, yaw);
  heading_ += w.turn * (time - last_time_);
  last_time_ = time;

  std::vector<double> progress(feet_.size(), 0.0);
  const double cycles = (time - options_.stand) / options_.period;
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    Foot& foot = feet_[i];
    const double phase = cycles + foot.offset - std::floor(cycles + foot.offset);
    // The first swing of the late diagonal waits for its own cycle.
    const bool swinging = cycles + foot.offset >= 1.0 && phase >= options_.duty;
    if (swinging && foot.standing) {
      foot.lifted = state.base * foot.leg.position(foot.leg.own(state.q));
    }
    foot.standing = !swinging;
    progress[i] = (phase - options_.duty) / (1.0 - options_.duty);
  }

  const std::vector<Eigen::Vector3d> pushes = stance_forces(state, w);
  Eigen::VectorXd tau = Eigen::VectorXd::Zero(robot_->joint_count());
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    const Foot& foot = feet_[i];
    const double remaining = (1.0 - progress[i]) * (1.0 - options_.duty) * options_.period;
    // The ground pushes a standing foot; the leg pushes a swinging one.
    const Eigen::Vector3d force = foot.standing
                                      ? Eigen::Vector3d(-pushes[i])
                                      : swing_force(foot, progress[i], remaining, state, w);
    const Eigen::Vector3d q = foot.leg.own(state.q);
    const Eigen::Vector3d leg_tau =
        foot.leg.jacobian(q).transpose() * (R.transpose() * force) +
        foot.leg.holding_torque(q, R.transpose() * Eigen::Vector3d(0.0, 0.0, -gravity));
    for (int k = 0; k < 3; ++k) {
      const int j = foot.leg.joints()[static_cast<std::size_t>(k)];
      const double limit = robot_->joint(j).effort;
      tau[j] = std::clamp(leg_tau[k], -limit, limit);
    }
  }
  return tau;
}

}  // namespace shapeid
