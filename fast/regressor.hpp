// Equations (1)-(3) at the pace of the robot: the columns of the sought links, into memory that is
// set aside once.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// The same matrix as `reference::regressor`, of which it keeps the columns of the wanted links,
/// under the same contract:
///
/// Equations (2)-(3): Y with Y Phi = H qddot + C qdot + G, dof x 10 links. Rows in generalised
/// order: base force (N) and moment about the base origin (N m) in base axes, then joint torques.
/// Columns: ten for each wanted link in the order they were wanted in. A fixed root's columns are
/// zero.
///
/// One forward pass moves the links on the way to a wanted one; then the wrench of each wanted link
/// counts in the joints that carry it. Nothing is done for other links, and entries that are zero
/// for every motion are written once, at construction.
class Regressor {
 public:
  /// `links`: indices in Robot::links. What is needed of the robot is copied. The only call that
  /// allocates.
  Regressor(const Robot& robot, const std::vector<int>& links);

  /// Y of this sample; the reference stays valid, and changes with the next call. Never allocates
  /// or throws. A sample for another number of joints is a defect of the caller: it ends the
  /// program where contracts are checked.
  const Eigen::MatrixXd& operator()(const Sample& sample) noexcept;

 private:
  /// A link on the way from the root to a wanted one, and how its joint moves it. Its orientation
  /// in its parent is `still + cos(q) even + sin(q) odd` (Rodrigues); a joint that slides only has
  /// `still`.
  struct Carried {
    int parent;  ///< place in carried_; the root is at 0
    int joint;   ///< number in the robot
    bool slides;
    Eigen::Vector3d axis;    ///< child frame
    Eigen::Vector3d origin;  ///< of the joint in the parent's frame, m
    Eigen::Matrix3d still, even, odd;
  };

  /// How a link's frame moves, in base axes, seen from the freely falling frame that coincides with
  /// the base at this instant (docs/derivations/moving-frame.md).
  struct Motion {
    Eigen::Matrix3d R;      ///< link axes to base axes
    Eigen::Vector3d p;      ///< link origin from the base origin, m
    Eigen::Vector3d omega;  ///< angular velocity, rad/s
    Eigen::Vector3d alpha;  ///< angular acceleration, rad/s^2
    Eigen::Vector3d a;      ///< proper acceleration of the link origin, m/s^2
    Eigen::Vector3d z;      ///< axis of the joint that carries the link
  };

  static Motion moved_by(const Motion& parent, const Carried& link, const Sample& sample) noexcept;
  void write_columns(int place, Eigen::Index first_column) noexcept;

  int joints_ = 0;
  int base_dof_ = 0;
  std::vector<Carried> carried_;  ///< parents first; the root's entry says nothing
  std::vector<Motion> motions_;   ///< of the same links
  std::vector<int> wanted_;       ///< places in carried_
  Eigen::MatrixXd Y_;
};

}  // namespace shapeid::fast
