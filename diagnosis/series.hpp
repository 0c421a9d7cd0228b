// What a model leaves of a recording, sample by sample.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// Root mean square of each row over its entries that count and are numbers; NaN where there are
/// none, for no error is not an error of zero.
[[nodiscard]] Eigen::VectorXd row_rms(
    const Eigen::MatrixXd& rows,
    const Eigen::Ref<const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>>& counted);

struct Series {
  std::vector<std::size_t> index;  ///< samples of the recording
  Eigen::MatrixXd residual;        ///< dof x samples: the yardstick, predicted minus logged
  Eigen::MatrixXd predicted;       ///< dof x samples: logged plus residual
  /// dof x samples: counted_rows(). The others are in no error.
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> counted;
  /// row_rms() of the residual.
  [[nodiscard]] Eigen::VectorXd rms() const { return row_rms(residual, counted); }
};

/// A log, and what a model leaves of it. Refers to the log.
struct Rest {
  const Recording& log;
  Series left;
};

[[nodiscard]] Series series(const Robot& robot, RowSource source, const RichModel& model,
                            const Recording& recording, std::size_t stride);

/// A row of `of`, the residual or what is predicted, less its mean; zero where it does not count.
[[nodiscard]] Eigen::VectorXd centred(const Series& series, const Eigen::MatrixXd& of,
                                      Eigen::Index row);

/// What a ripple's size is in proportion to: nothing, or the predicted force of its joint.
enum class RippleOf { torque, load };
/// The frequency N (1/rad) from lower to upper of the ripple over the position of joint `over` that
/// explains most of what is left in the row of `joint`: cos(N q), sin(N q) and a constant, times
/// what it is of. `lower` if no row counts.
[[nodiscard]] double strongest_ripple(const Robot& robot, const Recording& recording,
                                      const Series& left, int joint, int over, RippleOf of,
                                      double lower, double upper);

}  // namespace shapeid::diagnosis
