// A force at a contact while its flag says one thing or the other.
#pragma once

#include <cstddef>

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

/// -J_contact^T in samples whose flag is `declared`, zero in the others: dof x 3.
inline Eigen::MatrixXd force_columns(const Instant& at, int contact, bool declared) {
  const auto c = static_cast<std::size_t>(contact);
  const bool flag = c < at.sample.in_contact.size() && at.sample.in_contact[c];
  if (flag != declared) return Eigen::MatrixXd::Zero(at.robot.dof(), 3);
  const Contact& place = at.robot.contacts[c];
  const Eigen::Vector3d point =
      at.motions[static_cast<std::size_t>(place.link)].pose * place.frame.translation();
  return -reference::point_jacobian(at.robot, at.motions, place.link, point)
              .topRows<3>()
              .transpose();
}

}  // namespace shapeid::diagnosis
