// Robots that touch something, with whole and with redundant contacts.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Core>
#include <utility>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// A robot of either kind of root with at least one contact and one degree of freedom.
[[nodiscard]] rc::Gen<Robot> touching_robot();

/// Such a robot and a sample of it. At times a contact is named twice, or three further points are
/// on its link, so that J^T loses rank.
[[nodiscard]] rc::Gen<std::pair<Robot, Sample>> robot_in_contact();

/// Positive weights over four orders of magnitude: the diagonal of W.
[[nodiscard]] rc::Gen<Eigen::VectorXd> weights(Eigen::Index size);

/// A leg of two links on a body: both joints about y, the knee exactly below the hip and the foot
/// exactly below the knee (but for y) at q = 0.
[[nodiscard]] Robot leg(Root root);

/// The leg at rest, with its joints at these angles (rad).
[[nodiscard]] Sample posture(double hip, double knee);

}  // namespace shapeid::test
