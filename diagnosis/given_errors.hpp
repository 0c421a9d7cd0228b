// What the given links leave of a log whose columns are taken for something else.
#pragma once

#include <Eigen/Core>

#include <functional>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// Squared errors (N m, N of sliders) of the joints' torques on some hundred samples, evenly:
/// enough for as coarse a question. The robot and the recording must outlive this.
class GivenErrors {
 public:
  GivenErrors(const Robot& robot, const Recording& recording, RowSource rows);

  using Change = std::function<void(Sample&)>;
  /// Of up to twenty parts of the log, each sample changed.
  [[nodiscard]] Eigen::VectorXd of_parts(const Change& change) const;
  [[nodiscard]] double of(const Change& change) const { return of_parts(change).sum(); }
  /// Of no links at all: the squared torque.
  [[nodiscard]] double of_nothing() const;
  /// As logged, with this effect.
  [[nodiscard]] double with(const AppliedEffect& effect) const;

 private:
  [[nodiscard]] Eigen::VectorXd left_by(const Eigen::VectorXd& Phi, const Change& change) const;

  const Robot& robot_;
  const Recording& recording_;
  Viewer viewer_;
  std::size_t stride_;
  std::vector<Sample> samples_;
  std::vector<Surroundings> surroundings_;
};

/// Whether errors of parts are less by the logarithms of their ratios: in a few parts a wrong
/// reading may leave more than in all others.
[[nodiscard]] bool are_less(const Eigen::VectorXd& errors, const Eigen::VectorXd& others);

}  // namespace shapeid::diagnosis
