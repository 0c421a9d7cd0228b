// Equations (1)-(3) at the pace of the robot: the columns of the sought links, into memory that is
// set aside once.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "shapeid/fast/kinematics.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// Equation (2), transposed: each of a body's ten parameters takes a row's force (N, first three)
/// and moment about the link origin (N m), link axes. So parameters share vector registers.
[[nodiscard]] Eigen::Matrix<double, 10, 6> body_wrench(const LinkMotion& link) noexcept;

/// Writes the ten columns of one link into `Y` (dof x 10), which holds zeros, or the same link's
/// columns of another sample: entries that are zero for every motion are left alone. The kinematics
/// have been started with the sample.
void write_columns(Kinematics& kinematics, int link,
                   Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 10>> Y) noexcept;

/// The same matrix as `reference::regressor`, of which it keeps the columns of the wanted links,
/// under the same contract:
///
/// Equations (2)-(3): Y with Y Phi = H qddot + C qdot + G, dof x (10 per link). Rows in generalised
/// order: base force (N) and moment about the base origin (N m) in base axes, then joint torques.
/// Columns: ten for each wanted link in the order they were wanted in. A fixed root's columns are
/// zero.
///
/// Only the links on the way to a wanted one are moved, each once; then the wrench of each wanted
/// link counts in the joints that carry it.
class Regressor {
 public:
  /// `links`: indices in Robot::links. What is needed of the robot is copied. The only call that
  /// allocates.
  Regressor(const Robot& robot, const std::vector<int>& links);

  /// Y of this sample; the reference stays valid, and changes with the next call. Never allocates
  /// or throws. A sample for another number of joints is a defect of the caller: it ends the
  /// program where contracts are checked.
  const Eigen::MatrixXd& operator()(const Sample& sample) noexcept;

  /// The same for a block of samples, one below the other in `Y`: dof rows a sample, ten columns a
  /// wanted link. Whatever stood in Y is overwritten. Never allocates or throws; a Y of another
  /// size is a defect of the caller.
  void of_block(std::span<const Sample> samples, Eigen::Ref<Eigen::MatrixXd> Y) noexcept;

 private:
  void write(const Sample& sample, Eigen::Ref<Eigen::MatrixXd> Y) noexcept;

  Kinematics kinematics_;
  std::vector<int> wanted_;
  Eigen::MatrixXd Y_;
};

}  // namespace shapeid::fast
