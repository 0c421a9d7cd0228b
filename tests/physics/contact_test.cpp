// The contact Jacobian of equation (1) against Simbody's, and the laws that its rows obey.
#include "shapeid/reference/contact.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/physics/touching.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::Vector3d;
using test::few_hundred_eps;
using test::scaled;
using test::scaled_difference;

Robot with_kind(Robot robot, ContactKind kind) {
  for (Contact& contact : robot.contacts) contact.kind = kind;
  return robot;
}

Sample touching_everywhere(Sample s) {
  s.in_contact.assign(s.in_contact.size(), true);
  return s;
}

RC_GTEST_PROP(ContactJacobian, PointsMoveAsSimbodySays, ()) {
  const Robot robot = with_kind(*test::touching_robot(), ContactKind::point);
  const Sample s = touching_everywhere(*test::sample(robot));
  RC_ASSERT(scaled_difference(reference::contact_jacobian(robot, s),
                              SimbodyRobot(robot).contact_point_jacobian(s.q),
                              robot.link_count()) < few_hundred_eps);
}

/// Three further points at unit distance from the contact's origin, along the axes of its frame.
Robot with_tripod(const Robot& robot, const Contact& contact) {
  Robot result = robot;
  result.contacts = {contact, contact, contact, contact};
  for (int axis = 0; axis < 3; ++axis) {
    result.contacts[static_cast<std::size_t>(axis) + 1].frame.translation() +=
        contact.frame.linear().col(axis);
  }
  return result;
}

// The rows that hold a link against turning, from the motion of points alone: turning about y moves
// the tip of z along x, and so on around.
RC_GTEST_PROP(ContactJacobian, AngularRowsFollowFromPoints, ()) {
  Robot robot = *test::touching_robot();
  robot.contacts.resize(1);
  Sample s = *test::sample(robot);
  s.in_contact = {true};

  const Robot tripod = with_tripod(robot, robot.contacts.front());
  const SimbodyRobot simbody(tripod);
  const Eigen::MatrixXd J = simbody.contact_point_jacobian(s.q);
  const Eigen::Matrix3Xd p = simbody.contact_positions(s.q);
  const auto axis = [&](int i) -> Vector3d { return p.col(i + 1) - p.col(0); };
  const auto tip = [&](int i) -> Eigen::MatrixXd {
    return J.middleRows<3>(Eigen::Index{3} * (i + 1)) - J.topRows<3>();
  };
  Eigen::MatrixXd turning(3, robot.dof());  // about the frame's x, y, z
  for (int about = 0; about < 3; ++about) {
    turning.row(about) =
        axis((about + 1) % 3).transpose() * tip((about + 2) % 3) * -1.0;  // z' . (w x y') = w . x
  }

  const double scale = J.norm() + p.norm();
  const auto residual = [&](const Eigen::MatrixXd& error) {
    return scaled(error.norm(), scale, robot.link_count());
  };
  robot.contacts.front().kind = ContactKind::line;
  const Eigen::MatrixXd line = reference::contact_jacobian(robot, s);
  RC_ASSERT(line.rows() == 5);
  RC_ASSERT(residual(line.topRows<3>() - J.topRows<3>()) < few_hundred_eps);
  RC_ASSERT(residual(line.bottomRows<2>() - turning.bottomRows<2>()) < few_hundred_eps);

  robot.contacts.front().kind = ContactKind::plane;
  const Eigen::MatrixXd plane = reference::contact_jacobian(robot, s);
  Eigen::Matrix3d axes;
  axes << axis(0), axis(1), axis(2);
  RC_ASSERT(plane.rows() == 6);
  RC_ASSERT(residual(plane.topRows<3>() - J.topRows<3>()) < few_hundred_eps);
  RC_ASSERT(residual(axes.transpose() * plane.bottomRows<3>() - turning) < few_hundred_eps);
}

RC_GTEST_PROP(ContactJacobian, HasTheRowsOfWhatTouchesInOrder, ()) {
  const Robot robot = *test::touching_robot();
  const Sample s = *test::sample(robot);
  Eigen::MatrixXd expected(0, robot.dof());
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    if (!s.in_contact[c]) continue;
    Robot alone = robot;
    alone.contacts = {robot.contacts[c]};
    Sample s_alone = s;
    s_alone.in_contact = {true};
    const Eigen::MatrixXd rows = reference::contact_jacobian(alone, s_alone);
    RC_ASSERT(rows.rows() == force_numbers(robot.contacts[c].kind));
    Eigen::MatrixXd stacked(expected.rows() + rows.rows(), robot.dof());
    stacked << expected, rows;
    expected = stacked;
  }
  RC_ASSERT(reference::contact_jacobian(robot, s) == expected);
}

RC_GTEST_PROP(ContactJacobian, TimesVelocityIsTheContactVelocity, ()) {
  const Robot robot = *test::touching_robot();
  const Sample s = *test::sample(robot);
  const Eigen::MatrixXd J = SimbodyRobot(robot).contact_point_jacobian(s.q);
  const Eigen::VectorXd velocity = test::generalised_velocity(robot, Vector3d::Zero(), s);
  const Eigen::Matrix3Xd v = reference::contact_motions(robot, s).velocity;
  RC_ASSERT(scaled((v.reshaped() - J * velocity).norm(), J.norm() * velocity.norm(),
                   robot.link_count()) < few_hundred_eps);
}

RC_GTEST_PROP(MeasuredForces, DoTheWorkThatSimbodySays, ()) {
  const Robot robot = *test::touching_robot();
  Sample s = *test::sample(robot);
  Eigen::VectorXd forces(3 * static_cast<Eigen::Index>(robot.contacts.size()));
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    s.contact_force.push_back(*test::vector3(200.0));
    forces.segment<3>(3 * static_cast<Eigen::Index>(c)) = s.contact_force[c];
  }
  const Eigen::MatrixXd J = SimbodyRobot(robot).contact_point_jacobian(s.q);
  RC_ASSERT(scaled((reference::measured_contact_force(robot, s) - J.transpose() * forces).norm(),
                   J.norm() * forces.norm(), robot.link_count()) < few_hundred_eps);
}

TEST(MeasuredForces, AreRefusedWhereNoneAreMeasured) {
  Robot robot;
  robot.links.resize(1);
  robot.contacts.resize(1);
  EXPECT_THROW(static_cast<void>(reference::measured_contact_force(robot, {})), Refusal);
}

}  // namespace
}  // namespace shapeid
