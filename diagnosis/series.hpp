// What a model leaves of a recording, sample by sample.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

struct Series {
  std::vector<std::size_t> index;  ///< samples of the recording
  Eigen::MatrixXd residual;        ///< dof x samples: the yardstick, predicted minus logged
  Eigen::MatrixXd predicted;       ///< dof x samples: logged plus residual
  /// dof x samples: counted_rows(). The others are in no error.
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> counted;
  /// Root mean square of each generalised row, over what counts.
  [[nodiscard]] Eigen::VectorXd rms() const;
};

[[nodiscard]] Series series(const Robot& robot, reference::ContactTreatment contacts,
                            const RichModel& model, const Recording& recording, std::size_t stride);

/// The frequency N (1/rad) in [lower, upper] whose cos(N x), sin(N x) explain most of y.
[[nodiscard]] double strongest_ripple(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                                      double lower, double upper);

}  // namespace shapeid::diagnosis
