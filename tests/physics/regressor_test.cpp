// Equations (1)-(3) against closed forms and against their own symmetries: what can be known
// without another implementation. The agreement with Simbody is in simbody_agreement_test.cpp.
#include "shapeid/reference/regressor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "shapeid/reference/inverse_dynamics.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::Vector3d;
using reference::regressor;
using test::few_hundred_eps;
using test::scaled;
using test::size_of_terms;

// Newton and Euler about the centre of mass, as in a textbook; the regressor works about the
// origin.
RC_GTEST_PROP(Regressor, FreeBodyObeysNewtonAndEuler, ()) {
  const Robot robot = *test::robot({1, 1, Root::floating});
  const Sample s = *test::sample(robot);
  const InertialParameters body = robot.links.front().inertia;
  const Vector3d c = body.centre_of_mass();
  const Vector3d omega = s.base_angular_velocity, alpha = s.base_angular_acceleration;

  const Vector3d force =
      body.mass() * (s.base_specific_force + alpha.cross(c) + omega.cross(omega.cross(c)));
  const Vector3d spin = body.tensor_about_centre() * omega;
  const Vector3d moment = body.tensor_about_centre() * alpha + omega.cross(spin) + c.cross(force);
  Eigen::VectorXd expected(6);
  expected << force, moment;

  const Eigen::MatrixXd Y = regressor(robot, s);
  RC_ASSERT(scaled((Y * body.values - expected).norm(), size_of_terms(Y, body.values), 10) <
            few_hundred_eps);
}

// Wrenches that are summed from the leaves to the root, against each link's alone by virtual power;
// of any numbers, also such as no body has.
RC_GTEST_PROP(Regressor, TimesParametersIsInverseDynamics, ()) {
  const Root root = *rc::gen::element(Root::floating, Root::fixed);
  const Robot robot = *test::robot({1, 12, root});
  const Sample s = *test::sample(robot);
  const Eigen::VectorXd Phi = *test::vector(10 * robot.link_count(), 3.0);
  const Eigen::VectorXd by_recursion =
      reference::inverse_dynamics(robot, reference::link_motions(robot, s), Phi);
  // Let loose, the root feels all wrenches whole; a joint may feel a small part of a large one.
  Robot loose = robot;
  loose.root = Root::floating;
  RC_ASSERT(by_recursion.size() == robot.dof());
  RC_ASSERT(scaled((regressor(robot, s) * Phi - by_recursion).norm(),
                   size_of_terms(regressor(loose, s), Phi), robot.link_count()) < few_hundred_eps);
}

// A door: a body on a fixed, tilted hinge, with its base at rest in gravity.
RC_GTEST_PROP(Regressor, HingedBodyIsAPhysicalPendulum, ()) {
  Robot robot = *test::robot({2, 2, Root::fixed});
  robot.links[1].joint.kind = JointKind::revolute;
  const Sample s = *test::sample(robot);
  const Joint& joint = robot.links[1].joint;
  const InertialParameters body = robot.links[1].inertia;

  const Eigen::Matrix3d R =
      joint.placement.linear() * Eigen::AngleAxisd(s.q[0], joint.axis).toRotationMatrix();
  const Vector3d gravity(0.0, 0.0, -9.81);
  const double about_hinge = joint.axis.dot(body.tensor() * joint.axis);
  const double weight = joint.axis.dot(body.first_moment().cross(R.transpose() * gravity));

  const Eigen::MatrixXd Y = regressor(robot, s);
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  RC_ASSERT(scaled(std::abs((Y * Phi)[0] - (about_hinge * s.ddq[0] - weight)),
                   size_of_terms(Y, Phi), 10) < few_hundred_eps);
}

// Two links swinging about z with all their mass in the plane: the equations every textbook has.
TEST(Regressor, PlanarDoublePendulumAsInTheTextbook) {
  constexpr double l1 = 0.7, c1 = 0.3, c2 = 0.45, m1 = 1.3, m2 = 0.8, I1 = 0.05, I2 = 0.02;
  const auto rod = [](double m, double c, double I) {
    return from_centre(m, {c, 0.0, 0.0}, Vector3d(0.6 * I, 0.7 * I, I).asDiagonal());
  };
  Robot robot;
  robot.root = Root::fixed;
  robot.links.resize(3);
  for (int i = 1; i < 3; ++i) {
    robot.links[static_cast<std::size_t>(i)].parent = i - 1;
    robot.links[static_cast<std::size_t>(i)].joint.axis = Vector3d::UnitZ();
  }
  robot.links[1].inertia = rod(m1, c1, I1);
  robot.links[2].inertia = rod(m2, c2, I2);
  robot.links[2].joint.placement.translation() << l1, 0.0, 0.0;

  constexpr double g = 9.81;
  Sample s;
  s.base_specific_force << 0.0, g, 0.0;  // y points up
  s.q = Eigen::Vector2d(0.4, -1.1);
  s.dq = Eigen::Vector2d(2.0, -3.5);
  s.ddq = Eigen::Vector2d(-7.0, 11.0);
  s.tau = Eigen::Vector2d::Zero();

  const double cos2 = std::cos(s.q[1]), h = m2 * l1 * c2 * std::sin(s.q[1]);
  const double H22 = I2 + m2 * c2 * c2, H12 = H22 + m2 * l1 * c2 * cos2;
  const double H11 = I1 + m1 * c1 * c1 + m2 * l1 * l1 + H22 + 2.0 * m2 * l1 * c2 * cos2;
  const double G2 = m2 * c2 * g * std::cos(s.q[0] + s.q[1]);
  const double G1 = (m1 * c1 + m2 * l1) * g * std::cos(s.q[0]) + G2;
  const Eigen::Vector2d expected(
      H11 * s.ddq[0] + H12 * s.ddq[1] - h * (2.0 * s.dq[0] * s.dq[1] + s.dq[1] * s.dq[1]) + G1,
      H12 * s.ddq[0] + H22 * s.ddq[1] + h * s.dq[0] * s.dq[0] + G2);

  const Eigen::MatrixXd Y = regressor(robot, s);
  const Eigen::VectorXd Phi = stacked_parameters(robot);
  EXPECT_LT(scaled((Y * Phi - expected).norm(), size_of_terms(Y, Phi), 20), few_hundred_eps);
}

/// The same mechanism with the frame of `link` put elsewhere on its body: turned by T and moved by
/// it, which for a revolute joint must be along the axis. T maps new coordinates to old.
Robot with_frame(Robot robot, int link, const Eigen::Isometry3d& T) {
  Link& moved_link = robot.links[static_cast<std::size_t>(link)];
  moved_link.joint.placement = moved_link.joint.placement * T;
  moved_link.joint.axis = T.linear().transpose() * moved_link.joint.axis;
  moved_link.inertia = moved(moved_link.inertia, T.inverse());
  for (Link& child : robot.links) {
    if (child.parent == link) child.joint.placement = T.inverse() * child.joint.placement;
  }
  return robot;
}

RC_GTEST_PROP(Regressor, FramesOnTheLinksDoNotMatter, ()) {
  const Robot robot = *test::robot({2, 8, Root::floating});
  const Sample s = *test::sample(robot);
  const int link = *rc::gen::inRange(1, robot.link_count());
  Eigen::Isometry3d T = *test::pose(0.5);
  const Joint& joint = robot.joint(link - 1);
  if (joint.kind != JointKind::prismatic) T.translation() = joint.axis * T.translation().x();
  const Robot other = with_frame(robot, link, T);

  const Eigen::MatrixXd Y = regressor(robot, s), Y_other = regressor(other, s);
  const Eigen::VectorXd Phi = stacked_parameters(robot), Phi_other = stacked_parameters(other);
  RC_ASSERT(scaled((Y * Phi - Y_other * Phi_other).norm(),
                   size_of_terms(Y, Phi) + size_of_terms(Y_other, Phi_other),
                   Phi.size()) < few_hundred_eps);
}

// A joint that does not move is a rigid connection: its link's parameters may be given to the
// parent.
RC_GTEST_PROP(Regressor, ALinkAtRestOnItsParentCanBeLumped, ()) {
  const Robot robot = *test::robot({2, 8, Root::floating});
  Sample s = *test::sample(robot);
  const int last = robot.link_count() - 1;  // carries no other link
  s.dq[last - 1] = 0.0;
  s.ddq[last - 1] = 0.0;
  const Link& leaf = robot.links[static_cast<std::size_t>(last)];
  Eigen::Isometry3d displacement = Eigen::Isometry3d::Identity();
  if (leaf.joint.kind == JointKind::prismatic) {
    displacement.translation() = s.q[last - 1] * leaf.joint.axis;
  } else {
    displacement.linear() = Eigen::AngleAxisd(s.q[last - 1], leaf.joint.axis).toRotationMatrix();
  }
  Robot lumped = robot;
  Link& leaf_of_lumped = lumped.links.back();
  Link& parent = lumped.links[static_cast<std::size_t>(leaf.parent)];
  parent.inertia = parent.inertia + moved(leaf.inertia, leaf.joint.placement * displacement);
  leaf_of_lumped.inertia = {};

  const Eigen::MatrixXd Y = regressor(robot, s);
  const Eigen::VectorXd Phi = stacked_parameters(robot), Phi_lumped = stacked_parameters(lumped);
  const Eigen::Index rows = robot.dof() - 1;  // all but the row of the joint at rest
  RC_ASSERT(scaled((Y * (Phi - Phi_lumped)).head(rows).norm(),
                   size_of_terms(Y, Phi) + size_of_terms(Y, Phi_lumped),
                   Phi.size()) < few_hundred_eps);
}

RC_GTEST_PROP(Regressor, FixedRootHasNoColumnsOfItsOwn, ()) {
  const Robot robot = *test::robot({1, 6, Root::fixed});
  const Eigen::MatrixXd Y = regressor(robot, *test::sample(robot));
  RC_ASSERT(Y.rows() == robot.joint_count());
  RC_ASSERT(Y.leftCols<10>().isZero(0.0));
}

TEST(Regressor, AppliedForceLeavesTheBaseFree) {
  Robot robot;
  robot.links.resize(3);
  robot.links[1].parent = 0;
  robot.links[2].parent = 0;
  Sample s;
  s.q = s.dq = s.ddq = Eigen::Vector2d::Zero();
  s.tau = Eigen::Vector2d(3.0, -4.0);
  Eigen::VectorXd expected(8);
  expected << 0, 0, 0, 0, 0, 0, 3.0, -4.0;
  EXPECT_EQ(reference::applied_force(robot, s), expected);
}

}  // namespace
}  // namespace shapeid
