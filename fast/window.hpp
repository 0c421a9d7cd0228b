// Equations (4)-(5): the weighted rows of many samples, compressed as they come.
#pragma once

#include <Eigen/Core>

#include <cstddef>

#include "shapeid/fast/sample_rows.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/models/body_model.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::fast {

/// What `reference::Window` collects, always as a triangle: R^T R = [Y F]^T [Y F] of the free
/// links, F with the known links moved over. Memory and the work of a call do not depend on the
/// number of samples. After construction nothing allocates or throws.
class Window {
 public:
  /// `weight`: diagonal of W in generalised order, 1 / sigma^2. Copies what it needs.
  Window(const Robot& robot, const BodyModel& model, ContactTreatment contacts,
         const Eigen::VectorXd& weight);

  /// Adds the rows of one sample. A sample that is declined changes nothing. One of other sizes is
  /// a defect of the caller: it ends the program where contracts are checked.
  [[nodiscard]] Verdict add(const Sample& sample) noexcept;

  /// As constructed: no samples.
  void clear() noexcept;

  /// All rows so far count by this factor in the sum of squares, 0 to 1: exponential forgetting.
  void forget(double factor) noexcept;

  /// The triangle of all rows so far. Not const: rows wait to be compressed many at a time. Valid,
  /// and the same, until the next call that adds, forgets or clears.
  const Triangle& triangle() noexcept;

  /// Samples taken since the window was made or cleared.
  [[nodiscard]] std::size_t samples() const noexcept { return samples_; }
  /// How many of them took the six-row path; the others took the general one.
  [[nodiscard]] std::size_t samples_by_six_rows() const noexcept { return samples_by_six_rows_; }

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("triangle", triangle_);
    Eigen::MatrixXd waiting = waiting_.topRows(used_);  // what lies below is not set
    archive("waiting", waiting);
    used_ = waiting.rows();
    waiting_.topRows(used_) = waiting;
    archive("constant", constant_);
    archive("samples", samples_);
    archive("samples_by_six_rows", samples_by_six_rows_);
  }

 private:
  void compress() noexcept;

  SampleRows sample_rows_;
  Triangle triangle_;
  Eigen::MatrixXd waiting_;  ///< [Y F], the first used_ rows count
  Eigen::Index used_ = 0;
  double constant_ = 0.0;  ///< sum of squares that waits as well
  std::size_t samples_ = 0, samples_by_six_rows_ = 0;
};

}  // namespace shapeid::fast
