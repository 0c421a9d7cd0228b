#include "shapeid/tests/support/trot.hpp"

#include <Eigen/QR>

#include <cmath>
#include <numbers>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {
namespace {

constexpr double rate = 500.0;  // Hz
constexpr double gait = 2.0;    // strides a second
constexpr double gravity = 9.81;

// Per coordinate; SI units. Velocities and accelerations are differentiated and filtered signals.
constexpr double gyro_noise = 0.0015, gyro_rate_noise = 0.3, accel_noise = 0.03;
constexpr double dq_noise = 0.01, ddq_noise = 0.5, tau_noise = 0.1;

/// A smooth signal with its first two derivatives: two sines with incommensurable frequencies.
class Wave {
 public:
  Wave(Draw& draw, double size)
      : a_(size * draw.between(0.5, 1.0)),
        b_(size * draw.between(0.1, 0.4)),
        wa_(2.0 * std::numbers::pi * gait * draw.between(0.9, 1.1)),
        wb_(2.0 * std::numbers::pi * gait * draw.between(2.1, 3.4)),
        pa_(draw.between(0.0, 2.0 * std::numbers::pi)),
        pb_(draw.between(0.0, 2.0 * std::numbers::pi)) {}

  [[nodiscard]] double value(double t) const {
    return a_ * std::sin(wa_ * t + pa_) + b_ * std::sin(wb_ * t + pb_);
  }
  [[nodiscard]] double first(double t) const {
    return a_ * wa_ * std::cos(wa_ * t + pa_) + b_ * wb_ * std::cos(wb_ * t + pb_);
  }
  [[nodiscard]] double second(double t) const {
    return -a_ * wa_ * wa_ * std::sin(wa_ * t + pa_) - b_ * wb_ * wb_ * std::sin(wb_ * t + pb_);
  }

 private:
  double a_, b_, wa_, wb_, pa_, pb_;
};

Eigen::VectorXd base_wrench(const Robot& robot, const Sample& s, const Eigen::VectorXd& Phi) {
  return (reference::regressor(robot, s) * Phi).head<6>();
}

void add_base_acceleration(const Eigen::Matrix<double, 6, 1>& by, Sample& s) {
  s.base_specific_force += by.head<3>();
  s.base_angular_acceleration += by.tail<3>();
}

/// The smallest change of the base's acceleration after which the standing feet can carry it.
void make_feasible(const Robot& robot, const Eigen::VectorXd& Phi, Sample& s) {
  const Eigen::MatrixXd J = reference::contact_jacobian(robot, s).leftCols<6>();
  const Eigen::VectorXd before = base_wrench(robot, s, Phi);
  Eigen::Matrix<double, 6, 6> inertia;
  for (Eigen::Index k = 0; k < 6; ++k) {
    Sample moved = s;
    add_base_acceleration(Eigen::Matrix<double, 6, 1>::Unit(k), moved);
    inertia.col(k) = base_wrench(robot, moved, Phi) - before;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> reach(J.transpose());
  const Eigen::MatrixXd unreachable =
      Eigen::MatrixXd::Identity(6, 6) - J.transpose() * reach.pseudoInverse();
  add_base_acceleration(
      -(unreachable * inertia).completeOrthogonalDecomposition().solve(unreachable * before), s);
}

void set_torques(const Robot& robot, const Eigen::VectorXd& Phi, Sample& s) {
  const Eigen::MatrixXd J = reference::contact_jacobian(robot, s);
  const Eigen::VectorXd needed = reference::regressor(robot, s) * Phi;
  const Eigen::VectorXd f = Eigen::MatrixXd(J.leftCols<6>().transpose())
                                .completeOrthogonalDecomposition()
                                .solve(needed.head<6>());
  s.tau = (needed - J.transpose() * f).tail(robot.joint_count());
}

void disturb(Draw& draw, Sample& s) {
  const auto add = [&draw](auto& v, double sigma) {
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] += sigma * draw.normal();
  };
  add(s.base_angular_velocity, gyro_noise);
  add(s.base_angular_acceleration, gyro_rate_noise);
  add(s.base_specific_force, accel_noise);
  add(s.dq, dq_noise);
  add(s.ddq, ddq_noise);
  add(s.tau, tau_noise);
}

}  // namespace

std::vector<Sample> trot(const Robot& robot, const Eigen::VectorXd& Phi, std::uint64_t seed,
                         std::size_t count, Noise noise) {
  Draw draw(seed);
  std::vector<Wave> joints, turns, pushes;
  for (int j = 0; j < robot.joint_count(); ++j) joints.emplace_back(draw, 0.35);  // rad
  for (int k = 0; k < 3; ++k) turns.emplace_back(draw, 0.05);                     // rad
  for (int k = 0; k < 3; ++k) pushes.emplace_back(draw, 2.5);                     // m/s^2
  // Abduction, hip, knee: a crouched leg, far from stretched.
  const Eigen::Vector3d crouch(0.0, 0.8, -1.5);
  const double start = draw.between(0.0, 1.0);

  std::vector<Sample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = start + static_cast<double>(i) / rate;
    Sample& s = samples[i];
    s.time = static_cast<double>(i) / rate;
    s.q.resize(robot.joint_count());
    s.dq.resize(robot.joint_count());
    s.ddq.resize(robot.joint_count());
    s.tau.setZero(robot.joint_count());
    for (Eigen::Index j = 0; j < s.q.size(); ++j) {
      const Wave& wave = joints[static_cast<std::size_t>(j)];
      s.q[j] = crouch[j % 3] + wave.value(t);
      s.dq[j] = wave.first(t);
      s.ddq[j] = wave.second(t);
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto place = static_cast<std::size_t>(k);
      s.base_angular_velocity[k] = turns[place].first(t);
      s.base_angular_acceleration[k] = turns[place].second(t);
      s.base_specific_force[k] = pushes[place].value(t) + (k == 2 ? gravity : 0.0);
    }
    // Contacts in the order FR, FL, RR, RL: one diagonal, then the other.
    const bool first_pair = std::fmod(t * gait, 1.0) < 0.5;
    s.in_contact = {first_pair, !first_pair, !first_pair, first_pair};
    make_feasible(robot, Phi, s);
    set_torques(robot, Phi, s);
    if (noise == Noise::sensors) disturb(draw, s);
  }
  return samples;
}

}  // namespace shapeid::test
