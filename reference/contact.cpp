#include "shapeid/reference/contact.hpp"

#include <cstddef>

#include "shapeid/models/error.hpp"

namespace shapeid::reference {
namespace {

const LinkMotion& motion_of(const Contact& contact, const std::vector<LinkMotion>& motions) {
  return motions[static_cast<std::size_t>(contact.link)];
}

/// Jacobian of the contact frame's origin, base axes.
Jacobian contact_point_jacobian(const Robot& robot, const std::vector<LinkMotion>& motions,
                                const Contact& contact) {
  const Eigen::Vector3d point = motion_of(contact, motions).pose * contact.frame.translation();
  return point_jacobian(robot, motions, contact.link, point);
}

/// The velocities that the contact holds at zero, one row each.
Eigen::MatrixXd contact_rows(const Robot& robot, const std::vector<LinkMotion>& motions,
                             const Contact& contact) {
  const Jacobian J = contact_point_jacobian(robot, motions, contact);
  switch (contact.kind) {
    case ContactKind::point:
      return J.topRows<3>();
    case ContactKind::line: {
      // A line cannot hold a moment about itself: only the turning about y and z is held.
      const Eigen::Matrix3d axes =
          motion_of(contact, motions).pose.linear() * contact.frame.linear();
      Eigen::MatrixXd rows(5, J.cols());
      rows << J.topRows<3>(), axes.rightCols<2>().transpose() * J.bottomRows<3>();
      return rows;
    }
    case ContactKind::plane:
      return J;
  }
  throw Defect("a contact of no known kind");
}

/// Empty if there is one for each contact, or none.
[[maybe_unused]] Violation why_not_flags(const std::vector<bool>& in_contact, const Robot& robot) {
  if (in_contact.empty() || in_contact.size() == robot.contacts.size()) return std::nullopt;
  return "not a flag for each contact";
}

}  // namespace

Eigen::MatrixXd contact_jacobian(const Robot& robot, const Sample& sample) {
  return contact_jacobian(robot, link_motions(robot, sample), sample.in_contact);
}

Eigen::MatrixXd contact_jacobian(const Robot& robot, const std::vector<LinkMotion>& motions,
                                 const std::vector<bool>& in_contact) {
  SHAPEID_CONTRACT(why_not_motions(motions, robot));
  SHAPEID_CONTRACT(why_not_flags(in_contact, robot));
  Eigen::MatrixXd J(0, robot.dof());
  for (std::size_t c = 0; c < in_contact.size(); ++c) {
    if (!in_contact[c]) continue;
    const Eigen::MatrixXd rows = contact_rows(robot, motions, robot.contacts[c]);
    J.conservativeResize(J.rows() + rows.rows(), Eigen::NoChange);
    J.bottomRows(rows.rows()) = rows;
  }
  return J;
}

Eigen::VectorXd measured_contact_force(const Robot& robot, const Sample& sample) {
  if (sample.contact_force.size() != robot.contacts.size()) {
    throw Refusal("no-contact-forces", "the sample has no measured force for each contact");
  }
  const std::vector<LinkMotion> motions = link_motions(robot, sample);
  Eigen::VectorXd JTf = Eigen::VectorXd::Zero(robot.dof());
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    const Jacobian J = contact_point_jacobian(robot, motions, robot.contacts[c]);
    JTf += J.topRows<3>().transpose() * sample.contact_force[c];
  }
  return JTf;
}

ContactMotions contact_motions(const Robot& robot, const Sample& sample) {
  const std::vector<LinkMotion> motions = link_motions(robot, sample);
  const auto count = static_cast<Eigen::Index>(robot.contacts.size());
  ContactMotions result{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index c = 0; c < count; ++c) {
    const Contact& contact = robot.contacts[static_cast<std::size_t>(c)];
    const LinkMotion& link = motion_of(contact, motions);
    const Eigen::Vector3d arm = link.pose.linear() * contact.frame.translation();
    result.place.col(c) = link.pose.translation() + arm;
    result.velocity.col(c) = link.velocity + link.angular_velocity.cross(arm);
  }
  return result;
}

}  // namespace shapeid::reference
