// Six rows instead of all: what a sample says about the base if its feet stand on regular legs.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include "shapeid/fast/kinematics.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// Contact-free rows of the base's ten parameters (docs/derivations/six-rows.md): torques of a
/// stance leg give the foot's force, forces give the base's rows. The triangle is that of equation
/// (9), to rounding, for a fraction of the work.
///
/// It declines where that is not so: a contact that is no point; a foot that is not carried by
/// exactly three joints of its own (on the base, on another leg's joint, named twice); a leg near a
/// singular posture; weights that make the rows near singular.
class SixRows {
 public:
  /// Of one sample, weighted and free of contact forces.
  struct Rows {
    Eigen::Matrix<double, 11, 6> transposed;  ///< of [Y F]
    /// Sum of squares of the rows that are free of the base's parameters as well: a constant of the
    /// objective.
    double constant = 0.0;
  };

  /// `robot` has a floating root. `weight`: diagonal of W. The only call that allocates.
  SixRows(const Robot& robot, const Eigen::VectorXd& weight);

  /// Of the sample that the kinematics were started with; `in_contact` are the contacts whose
  /// forces are unknown, as in Sample. `F`: applied force less what is known, generalised order.
  /// False if declined; then `rows` are not to be used. Never allocates or throws.
  [[nodiscard]] bool operator()(Kinematics& kinematics, const std::vector<bool>& in_contact,
                                const Eigen::VectorXd& F, Rows& rows) noexcept;

 private:
  /// A point foot on three joints.
  struct Leg {
    bool stands_alone = false;  ///< it is such a leg
    std::array<int, 3> links = {};
    Eigen::Vector3d foot;  ///< in the last link's frame
  };

  std::vector<Leg> legs_;  ///< one for each contact
  Eigen::VectorXd weight_, root_, inverse_root_;
  std::vector<bool> standing_;  ///< joints of legs whose foot touches
};

}  // namespace shapeid::fast
