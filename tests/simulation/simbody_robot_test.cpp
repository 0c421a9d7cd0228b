// Simbody against closed forms: what the other tests take as independent physics is itself checked
// against something simpler.
#include "shapeid/models/simbody/simbody_robot.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled_difference;

Eigen::Isometry3d shifted(double x, double y, double z) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << x, y, z;
  return T;
}

/// Newton and Euler about the base origin for one body, from its parameters alone.
Eigen::VectorXd newton_euler(const InertialParameters& body, const Sample& s) {
  const Eigen::Vector3d& w = s.base_angular_velocity;
  const Eigen::Vector3d& dw = s.base_angular_acceleration;
  const Eigen::Vector3d& a = s.base_specific_force;
  const Eigen::Vector3d h = body.first_moment();
  Eigen::VectorXd wrench(6);
  wrench << body.mass() * a + dw.cross(h) + w.cross(w.cross(h)),
      body.tensor() * dw + w.cross(body.tensor() * w) + h.cross(a);
  return wrench;
}

RC_GTEST_PROP(SimbodyRobot, FreeBodyObeysNewtonAndEuler, ()) {
  test::TreeShape one_link;
  one_link.most_links = 1;
  const Robot robot = *test::robot(one_link);
  const Sample s = *test::sample(robot);
  const InertialParameters& body = robot.links[0].inertia;
  const Eigen::VectorXd expected = newton_euler(body, s);
  // Gravity goes in as a force and out as acceleration: a weightless sample leaves its rounding.
  const double scale = expected.norm() + 9.81 * body.values.norm();
  const double error = (SimbodyRobot(robot).inverse_dynamics(s) - expected).norm();
  RC_ASSERT(test::scaled(error, scale, 10) < few_hundred_eps);
}

/// Two links in a vertical plane, hanging down at q = 0, joints about -y of frames turned about x.
Robot double_pendulum() {
  Robot robot;
  robot.name = "double pendulum";
  robot.root = Root::fixed;
  robot.links.resize(3);
  for (int i = 1; i < 3; ++i) {
    Link& link = robot.links[static_cast<std::size_t>(i)];
    link.name = "arm" + std::to_string(i);
    link.parent = i - 1;
    link.joint.axis = -Eigen::Vector3d::UnitY();
  }
  robot.links[0].inertia = from_centre(5.0, {0.1, 0.2, 0.3}, Eigen::Matrix3d::Identity());
  robot.links[1].joint.placement = shifted(0.2, 0.4, 1.0);
  robot.links[2].joint.placement = shifted(0.05, 0.1, -0.5);
  robot.links[1].inertia =
      from_centre(1.3, {0.0, 0.03, -0.2}, Eigen::Vector3d(0.02, 0.03, 0.015).asDiagonal());
  robot.links[2].inertia =
      from_centre(0.7, {0.0, -0.02, -0.15}, Eigen::Vector3d(0.011, 0.013, 0.004).asDiagonal());
  return robot;
}

/// Lagrange's equations of the double pendulum, with the second joint's place in polar form.
Eigen::Vector2d lagrange(const Robot& robot, const Sample& s) {
  const InertialParameters& b1 = robot.links[1].inertia;
  const InertialParameters& b2 = robot.links[2].inertia;
  const double m2 = b2.mass();
  const double c1 = -b1.centre_of_mass().z();
  const double c2 = -b2.centre_of_mass().z();
  const double I1 = b1.tensor_about_centre()(1, 1);
  const double I2 = b2.tensor_about_centre()(1, 1);
  const Eigen::Vector3d elbow = robot.links[2].joint.placement.translation();
  const double l = std::hypot(elbow.x(), elbow.z());
  const double bend = std::atan2(elbow.x(), -elbow.z());  // of the elbow ahead of the arm

  const double a1 = s.q[0];
  const double a2 = s.q[0] + s.q[1];
  const double w1 = s.dq[0];
  const double w2 = s.dq[0] + s.dq[1];
  const double e1 = s.ddq[0];
  const double e2 = s.ddq[0] + s.ddq[1];
  const double g = 9.81;
  const double delta = a1 + bend - a2;
  // Momentum equations in the absolute angles a1, a2.
  const double t1 = (I1 + b1.mass() * c1 * c1 + m2 * l * l) * e1 +
                    m2 * l * c2 * (std::cos(delta) * e2 + std::sin(delta) * w2 * w2) +
                    g * (b1.mass() * c1 * std::sin(a1) + m2 * l * std::sin(a1 + bend));
  const double t2 = (I2 + m2 * c2 * c2) * e2 +
                    m2 * l * c2 * (std::cos(delta) * e1 - std::sin(delta) * w1 * w1) +
                    g * m2 * c2 * std::sin(a2);
  return {t1 + t2, t2};
}

RC_GTEST_PROP(SimbodyRobot, DoublePendulumObeysLagrange, ()) {
  const Robot robot = double_pendulum();
  const Sample s = *test::sample(robot);
  RC_ASSERT(scaled_difference(SimbodyRobot(robot).inverse_dynamics(s), lagrange(robot, s), 10) <
            few_hundred_eps);
}

// A link slides along an oblique axis: only the force along the axis and its reaction remain.
TEST(SimbodyRobot, SliderPushesItsMassAlongItsAxis) {
  Robot robot;
  robot.root = Root::fixed;
  robot.links.resize(2);
  robot.links[1].parent = 0;
  robot.links[1].joint.kind = JointKind::prismatic;
  robot.links[1].joint.axis = Eigen::Vector3d(0.6, 0.0, 0.8);
  robot.links[1].inertia = from_centre(2.5, {0.3, 0.1, 0.2}, Eigen::Matrix3d::Identity());
  Sample s;
  s.q = Eigen::VectorXd::Constant(1, 0.4);
  s.dq = Eigen::VectorXd::Constant(1, -1.5);
  s.ddq = Eigen::VectorXd::Constant(1, 3.0);
  const Eigen::VectorXd expected = Eigen::VectorXd::Constant(1, 2.5 * (3.0 + 9.81 * 0.8));
  EXPECT_LT(scaled_difference(SimbodyRobot(robot).inverse_dynamics(s), expected, 10),
            few_hundred_eps);
}

RC_GTEST_PROP(SimbodyRobot, InverseDynamicsAreLinearInAccelerationsByTheMassMatrix, ()) {
  const Robot robot = *test::robot(test::TreeShape());
  Sample s = *test::sample(robot);
  const SimbodyRobot simbody(robot);
  const Eigen::VectorXd with = simbody.inverse_dynamics(s);
  Eigen::VectorXd acceleration(robot.dof());
  acceleration << s.base_specific_force, s.base_angular_acceleration, s.ddq;
  const Eigen::VectorXd inertial = simbody.mass_matrix(s.q) * acceleration;
  s.base_specific_force.setZero();
  s.base_angular_acceleration.setZero();
  s.ddq.setZero();
  const Eigen::VectorXd without = simbody.inverse_dynamics(s);
  const double scale = with.norm() + without.norm() + inertial.norm();
  RC_ASSERT(test::scaled((with - without - inertial).norm(), scale, robot.dof()) < few_hundred_eps);
}

RC_GTEST_PROP(SimbodyRobot, ContactJacobianIsTheDerivativeOfContactPositions, ()) {
  const Robot robot = *test::robot(test::TreeShape());
  const Sample s = *test::sample(robot);
  const SimbodyRobot simbody(robot);
  const Eigen::MatrixXd J = simbody.contact_point_jacobian(s.q);
  const Eigen::Matrix3Xd at = simbody.contact_positions(s.q);
  // Central differences lose eps / h to rounding and h^2 to truncation: h = eps^(1/3) is best, and
  // what remains is of the order eps^(2/3) = 4e-11 of the positions' and derivatives' size.
  const double h = 6e-6;
  const double slack = 1e-8;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(robot.joint_count(), j);
    const Eigen::Matrix3Xd slope =
        (simbody.contact_positions(s.q + step) - simbody.contact_positions(s.q - step)) / (2.0 * h);
    for (Eigen::Index c = 0; c < at.cols(); ++c) {
      const Eigen::Vector3d column = J.block<3, 1>(3 * c, 6 + j);
      RC_ASSERT((column - slope.col(c)).norm() < slack * (1.0 + at.col(c).norm()));
    }
  }
  for (Eigen::Index c = 0; c < at.cols(); ++c) {
    // With the base: moves along, and w x r.
    Eigen::Matrix<double, 3, 6> base;
    const Eigen::Vector3d r = at.col(c);
    base << 1, 0, 0, 0, r.z(), -r.y(), 0, 1, 0, -r.z(), 0, r.x(), 0, 0, 1, r.y(), -r.x(), 0;
    RC_ASSERT(scaled_difference(J.block<3, 6>(3 * c, 0), base, 20) < few_hundred_eps);
  }
}

RC_GTEST_PROP(SimbodyRobot, KineticEnergyIsTheQuadraticFormOfTheMassMatrix, ()) {
  const Robot robot = *test::robot(test::TreeShape());
  const Sample s = *test::sample(robot);
  RobotState state;
  state.base = *test::pose(2.0);
  state.base_linear_velocity = *test::vector3(3.0);
  state.base_angular_velocity = s.base_angular_velocity;
  state.q = s.q;
  state.dq = s.dq;
  Eigen::VectorXd nu(robot.dof());
  nu << state.base_linear_velocity, state.base_angular_velocity, state.dq;
  const SimbodyRobot simbody(robot);
  const Eigen::MatrixXd H = simbody.mass_matrix(s.q);
  const double scale = H.norm() * nu.squaredNorm();
  RC_ASSERT(test::scaled(std::abs(simbody.kinetic_energy(state) - 0.5 * nu.dot(H * nu)), scale,
                         robot.dof()) < few_hundred_eps);
}

RC_GTEST_PROP(SimbodyRobot, PotentialEnergyOfOneBodyIsItsWeightTimesItsHeight, ()) {
  test::TreeShape one_link;
  one_link.most_links = 1;
  const Robot robot = *test::robot(one_link);
  RobotState state;
  state.base = *test::pose(2.0);
  state.q.resize(0);
  state.dq.resize(0);
  const InertialParameters& body = robot.links[0].inertia;
  const Eigen::Vector3d centre = state.base * body.centre_of_mass();
  const double expected = body.mass() * 9.81 * centre.z();
  const double scale = body.mass() * 9.81 * (state.base.translation().norm() + centre.norm());
  RC_ASSERT(test::scaled(std::abs(SimbodyRobot(robot).potential_energy(state) - expected), scale,
                         10) < few_hundred_eps);
}

TEST(SimbodyRobot, RefusesABodyThatCannotExist) {
  Robot robot = double_pendulum();
  robot.links[2].inertia = from_centre(1.0, {0, 0, 0}, Eigen::Vector3d(1.0, 1.0, 2.5).asDiagonal());
  EXPECT_THROW(SimbodyRobot{robot}, InputError);
}

TEST(SimbodyRobot, AFixedRootHasNoDynamics) {
  Robot robot = double_pendulum();
  Sample s;
  s.q = Eigen::Vector2d(0.3, -0.8);
  s.dq = Eigen::Vector2d(1.0, 2.0);
  s.ddq = Eigen::Vector2d(-4.0, 3.0);
  const Eigen::VectorXd before = SimbodyRobot(robot).inverse_dynamics(s);
  robot.links[0].inertia = 7.0 * robot.links[0].inertia;
  EXPECT_EQ(SimbodyRobot(robot).inverse_dynamics(s), before);
}

}  // namespace
}  // namespace shapeid
