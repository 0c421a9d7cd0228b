// One sample's rows of equations (1)-(9), for the links that are sought, weighted and free of
// contact forces.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "shapeid/fast/contact.hpp"
#include "shapeid/fast/inverse_dynamics.hpp"
#include "shapeid/fast/kinematics.hpp"
#include "shapeid/fast/projection.hpp"
#include "shapeid/fast/six_rows.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// What became of a sample.
enum class Verdict {
  taken,
  not_finite,        ///< declined: a number of it, or a square that follows from it, is not finite
  no_contact_forces  ///< declined: forces should be measured, and are not there for each contact
};

/// An entry for each joint, and for each contact or none at all.
[[nodiscard]] bool has_sizes(const Sample& sample, int joints, std::size_t contacts) noexcept;

/// What `reference::sample_rows` and `reference::eliminate_contacts` compute together, up to the
/// rotation that Q2 leaves open: [Y F]^T [Y F] is the same.
class SampleRows {
 public:
  /// `model`: its known parameters and free links. `weight`: diagonal of W, generalised order.
  /// Copies what it needs. The only call that allocates.
  SampleRows(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
             const Eigen::VectorXd& weight);

  /// Makes the rows of this sample. A sample of other sizes is a defect of the caller: it ends the
  /// program where contracts are checked. A declined sample leaves no rows. Never allocates or
  /// throws.
  [[nodiscard]] Verdict update(const Sample& sample) noexcept;

  /// [Y F] at the last update: rows x (10 n + 1), n free links. Valid until the next.
  [[nodiscard]] Eigen::Block<const Eigen::MatrixXd> rows() const noexcept {
    return rows_.block(first_, 0, count_, rows_.cols());
  }
  /// Sum of squares of further rows, which are zero in Y: a constant of the objective.
  [[nodiscard]] double constant() const noexcept { return constant_; }
  /// The rows are those of the six-row path (docs/derivations/six-rows.md), not of the general one.
  [[nodiscard]] bool by_six_rows() const noexcept { return by_six_rows_; }

 private:
  void project(const Sample& sample) noexcept;

  ContactTreatment contacts_;
  std::vector<int> free_links_;
  Kinematics kinematics_;
  InverseDynamics known_;
  MeasuredForces measured_;
  ContactJacobian jacobian_;
  ContactElimination elimination_;
  std::optional<SixRows> six_rows_;  ///< if the base alone is sought
  SixRows::Rows six_;
  const std::vector<bool> nothing_touches_;
  Eigen::VectorXd F_;
  Eigen::MatrixXd rows_;
  Eigen::Index first_ = 0, count_ = 0;
  double constant_ = 0.0;
  bool by_six_rows_ = false;
};

}  // namespace shapeid::fast
