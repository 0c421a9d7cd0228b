// Power balance: what the generalised forces of equation (1) put in is what Simbody's energies
// gain. Energies know no accelerations and no Coriolis terms, so this is another law than inverse
// dynamics; and they need the world's attitude and velocity, on which Y must not depend.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d turned(const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

/// A motion through `now` with the velocities of `now` and the accelerations of `s` at t = 0. Only
/// the first derivative at t = 0 counts, so positions and velocities run straight on.
RobotState after(const RobotState& now, const Sample& s, double t) {
  const Eigen::Matrix3d R = now.base.linear();
  // Components in base axes change by the turning of the axes too.
  const Vector3d base_acceleration = s.base_specific_force +
                                     R.transpose() * SimbodyRobot::gravity() -
                                     s.base_angular_velocity.cross(now.base_linear_velocity);
  RobotState later = now;
  later.base.linear() = R * turned(t * s.base_angular_velocity);
  later.base.translation() += t * R * now.base_linear_velocity;
  later.base_linear_velocity += t * base_acceleration;
  later.base_angular_velocity += t * s.base_angular_acceleration;
  later.q += t * s.dq;
  later.dq += t * s.ddq;
  return later;
}

RobotState state_of(const Sample& s, const Eigen::Isometry3d& base, const Vector3d& velocity) {
  return {base, velocity, s.base_angular_velocity, s.q, s.dq};
}

/// How fast anything turns, speeds up or moves, 1/s (lengths in metres).
double rate(const RobotState& state, const Sample& s) {
  const double velocities =
      s.base_angular_velocity.norm() + s.dq.lpNorm<1>() + state.base_linear_velocity.norm();
  const double accelerations = s.base_angular_acceleration.norm() + s.ddq.lpNorm<1>() +
                               s.base_specific_force.norm() + SimbodyRobot::gravity().norm();
  return velocities + std::sqrt(accelerations);
}

/// d/dt of Simbody's total energy along `after`, by a central difference of fourth order, and the
/// size of the energies that were subtracted.
struct EnergyRate {
  double value = 0.0;
  double size = 0.0;
};

EnergyRate energy_rate(const SimbodyRobot& simbody, const RobotState& now, const Sample& s,
                       double h) {
  EnergyRate result;
  const auto energy = [&](double t) {
    const RobotState state = after(now, s, t);
    const double kinetic = simbody.kinetic_energy(state);
    const double potential = simbody.potential_energy(state);
    result.size = std::max(result.size, std::abs(kinetic) + std::abs(potential));
    return kinetic + potential;
  };
  result.value =
      (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
  return result;
}

/// A fourth-order difference is at its best with h = eps^(1/5) / rate: truncation and rounding are
/// then both about eps^(4/5) of E rate. In these units, the imbalance of power.
double power_residual(const Robot& robot, const Sample& s, const RobotState& now) {
  const double fifth_root = std::pow(std::numeric_limits<double>::epsilon(), 1.0 / 5.0);
  const double r = rate(now, s);
  const EnergyRate gained = energy_rate(SimbodyRobot(robot), now, s, fifth_root / r);

  const Eigen::VectorXd velocity = test::generalised_velocity(robot, now.base_linear_velocity, s);
  const Eigen::MatrixXd Y = reference::regressor(robot, s);
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  const double put_in = velocity.dot(Y * Phi);
  const double terms = velocity.cwiseAbs().dot(Y.cwiseAbs() * Phi.cwiseAbs());
  return test::scaled(std::abs(put_in - gained.value), (gained.size * r + terms) / fifth_root, 1);
}

RC_GTEST_PROP(PowerBalance, FloatingRobotWhereverItIs, ()) {
  const Robot robot = *test::robot({1, 10, Root::floating});
  const Sample s = *test::sample(robot);
  const RobotState now = state_of(s, *test::pose(2.0), *test::vector3(3.0));
  RC_ASSERT(power_residual(robot, s, now) < test::few_hundred_eps);
}

RC_GTEST_PROP(PowerBalance, FixedRobotInGravity, ()) {
  const Robot robot = *test::robot({2, 10, Root::fixed});
  const Sample s = *test::sample(robot);
  const RobotState now = state_of(s, Eigen::Isometry3d::Identity(), Vector3d::Zero());
  RC_ASSERT(power_residual(robot, s, now) < test::few_hundred_eps);
}

// 1/2 nu^T H nu from the columns that unit accelerations of a robot at rest add to Y Phi.
RC_GTEST_PROP(PowerBalance, MassMatrixIsWhatAccelerationsAdd, ()) {
  const Robot robot = *test::robot({2, 10, Root::floating});
  Sample s = *test::sample(robot);
  s.base_angular_velocity.setZero();
  s.dq.setZero();
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  const auto force_of_unit = [&](Eigen::Index moving) -> Eigen::VectorXd {
    Sample unit = s;
    unit.base_specific_force.setZero();
    unit.base_angular_acceleration.setZero();
    unit.ddq.setZero();
    if (moving < 3) {
      unit.base_specific_force[moving] = 1.0;
    } else if (moving < 6) {
      unit.base_angular_acceleration[moving - 3] = 1.0;
    } else {
      unit.ddq[moving - 6] = 1.0;
    }
    return reference::regressor(robot, unit) * Phi;
  };
  Eigen::MatrixXd H(robot.dof(), robot.dof());
  for (Eigen::Index k = 0; k < H.cols(); ++k) H.col(k) = force_of_unit(k);
  RC_ASSERT(test::scaled_difference(H, SimbodyRobot(robot).mass_matrix(s.q), robot.link_count()) <
            test::few_hundred_eps);
}

}  // namespace
}  // namespace shapeid
