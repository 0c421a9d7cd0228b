// The contact Jacobian J of equation (1): where J^T f enters the dynamics.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/reference/kinematics.hpp"

namespace shapeid::reference {

/// Rows of J of every contact that touches in this sample, in the robot's order of contacts;
/// columns in generalised order. A point has 3 rows, the velocity of its origin in base axes; a
/// line 5, the angular velocity about its frame's y and z added; a plane 6, the angular velocity in
/// base axes added. No row if nothing touches.
[[nodiscard]] Eigen::MatrixXd contact_jacobian(const Robot& robot, const Sample& sample);
/// The same where the links' motions (link_motions()) are there already. `in_contact`: of the
/// robot's contacts, as in Sample.
[[nodiscard]] Eigen::MatrixXd contact_jacobian(const Robot& robot,
                                               const std::vector<LinkMotion>& motions,
                                               const std::vector<bool>& in_contact);

/// J^T f of equation (4) from the sample's measured forces, generalised order. Forces act at the
/// origins of all contacts, whether or not they are said to touch: a measured force needs no label.
/// Moments are not measured and count as zero. Throws Refusal ("no-contact-forces") if the sample
/// has no force for each contact.
[[nodiscard]] Eigen::VectorXd measured_contact_force(const Robot& robot, const Sample& sample);

/// Of each contact point in base axes, 3 x contacts: where it is, m, and its velocity relative to
/// the base origin's, m/s. Stance feet should agree on minus the base velocity.
struct ContactMotions {
  Eigen::Matrix3Xd place, velocity;
};
[[nodiscard]] ContactMotions contact_motions(const Robot& robot, const Sample& sample);

}  // namespace shapeid::reference
