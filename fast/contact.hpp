// The contact Jacobian J of equation (1) into memory that is set aside once.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/fast/kinematics.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// The same rows as `reference::contact_jacobian`: of every contact that touches, in the robot's
/// order of contacts; columns in generalised order. A point has 3 rows, the velocity of its origin
/// in base axes; a line 5, the angular velocity about its frame's y and z added; a plane 6, the
/// angular velocity in base axes added.
class ContactJacobian {
 public:
  /// The only call that allocates.
  explicit ContactJacobian(const Robot& robot);

  /// Of the sample that the kinematics of the same robot were started with. Never allocates or
  /// throws.
  void update(Kinematics& kinematics, const Sample& sample) noexcept;

  /// Rows of J at the last update.
  [[nodiscard]] Eigen::Index rows() const noexcept { return rows_; }
  /// The most rows that J can have: all contacts touch.
  [[nodiscard]] Eigen::Index most_rows() const noexcept { return transposed_.cols(); }
  /// J^T: dof x rows. A force counts in each generalised direction.
  [[nodiscard]] auto transposed() const noexcept { return transposed_.leftCols(rows_); }

 private:
  std::vector<Contact> contacts_;
  Eigen::MatrixXd transposed_;
  Eigen::Index rows_ = 0;
};

/// Adds J^T f of equation (4) to `force`, in generalised order, as
/// `reference::measured_contact_force` computes it: the sample's measured forces at the origins of
/// all contacts, whether or not they are said to touch.
class MeasuredForces {
 public:
  explicit MeasuredForces(const Robot& robot) : contacts_(robot.contacts) {}

  [[nodiscard]] std::size_t contacts() const noexcept { return contacts_.size(); }

  /// False, and `force` is left alone, if the sample has no force for each contact.
  [[nodiscard]] bool add_to(Eigen::VectorXd& force, Kinematics& kinematics,
                            const Sample& sample) const noexcept;

 private:
  std::vector<Contact> contacts_;
};

}  // namespace shapeid::fast
