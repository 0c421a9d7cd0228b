#include "shapeid/diagnosis/given_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/tally.hpp"
#include "shapeid/models/student.hpp"

namespace shapeid::diagnosis {

GivenErrors::GivenErrors(const Robot& robot, const Recording& recording, RowSource rows)
    : robot_(robot),
      recording_(recording),
      viewer_(robot, rows, {}),
      stride_(recording.stride_of(600)) {
  for (const std::size_t i : recording.usable(stride_)) {
    samples_.push_back(recording[i]);
    surroundings_.push_back(recording.surroundings(i));
  }
}

Eigen::VectorXd GivenErrors::of_parts(const Change& change) const {
  return left_by(stacked_parameters(robot_), change);
}

double GivenErrors::of_nothing() const {
  return left_by(Eigen::VectorXd::Zero(Eigen::Index{10} * robot_.link_count()), [](Sample&) {})
      .sum();
}

double GivenErrors::with(const AppliedEffect& effect) const {
  const RichModel model{stacked_parameters(robot_), {effect}};
  return series(robot_, viewer_.source(), model, recording_, stride_)
      .residual.bottomRows(robot_.joint_count())
      .squaredNorm();
}

Eigen::VectorXd GivenErrors::left_by(const Eigen::VectorXd& Phi, const Change& change) const {
  constexpr double most_parts = 20.0;
  const auto parts =
      static_cast<std::size_t>(std::clamp(recording_.duration() / shortest_block, 1.0, most_parts));
  const RichModel model{Phi, {}};
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parts));
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    Sample changed = samples_[i];
    change(changed);
    const View view = viewer_.view(std::move(changed), surroundings_[i]);
    sums[static_cast<Eigen::Index>(i * parts / samples_.size())] +=
        residual(viewer_, view, model).tail(robot_.joint_count()).squaredNorm();
  }
  return sums;
}

bool are_less(const Eigen::VectorXd& errors, const Eigen::VectorXd& others) {
  const Eigen::ArrayXd ratio = (others.array() / errors.array()).log();
  const auto count = static_cast<double>(ratio.size());
  const double mean = ratio.mean();
  const double error = std::sqrt((ratio - mean).square().sum() / (count * (count - 1.0)));
  return mean > limit_for(4.0, ratio.size()) * error;
}

}  // namespace shapeid::diagnosis
