#include "shapeid/diagnosis/accelerometer_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/signed_axes.hpp"

namespace shapeid::diagnosis {
namespace {

/// Squared residuals of some hundred samples, evenly: enough for as coarse a question.
class Errors {
 public:
  Errors(const Robot& robot, const Recording& recording, ContactTreatment contacts)
      : viewer_(robot, contacts, {}), given_{stacked_parameters(robot), {}} {
    for (const std::size_t i : recording.usable(recording.stride_of(200))) {
      samples_.push_back(recording[i]);
      surroundings_.push_back(recording.surroundings(i));
    }
  }

  [[nodiscard]] double of(const RichModel& model, const Eigen::Matrix3d& turn) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Sample turned = samples_[i];
      turned.base_specific_force = turn * turned.base_specific_force;
      const View view = viewer_.view(turned, surroundings_[i]);
      sum += residual(viewer_, view, model).tail(viewer_.robot().joint_count()).squaredNorm();
    }
    return sum;
  }
  [[nodiscard]] double of_given(const Eigen::Matrix3d& turn) const { return of(given_, turn); }
  [[nodiscard]] double of_torque() const {
    return of({Eigen::VectorXd::Zero(given_.Phi.size()), {}}, Eigen::Matrix3d::Identity());
  }

 private:
  Viewer viewer_;
  RichModel given_;
  std::vector<Sample> samples_;
  std::vector<Surroundings> surroundings_;
};

}  // namespace

void check_accelerometer(const Robot& robot, const Recording& recording,
                         ContactTreatment contacts) {
  if (robot.root == Root::fixed) return;
  const Errors errors(robot, recording, contacts);
  // Of the squared torque: below a tenth of its rms no axis is wrong, and above a half all is.
  constexpr double badly = 0.01, well = 0.25;
  const double torque = errors.of_torque();
  const double as_logged = errors.of_given(Eigen::Matrix3d::Identity());
  if (!(as_logged > badly * torque)) return;
  constexpr double far_better = 0.25;
  double least = std::min(far_better * as_logged, well * torque);
  const SignedAxes* best = nullptr;
  for (const SignedAxes& axes : all_signed_axes()) {
    const double left = errors.of_given(axes.matrix());
    if (!(left < least)) continue;
    least = left;
    best = &axes;
  }
  if (best == nullptr) return;
  throw Refusal("imu-axes",
                fmt::format("the given model leaves {:.0f} % of the logged torque's rms, and "
                            "{:.0f} % if the accelerometer's axes were {}: turn the IMU "
                            "(robot.yaml), or the accelerometer in the mapping",
                            1e2 * std::sqrt(as_logged / torque), 1e2 * std::sqrt(least / torque),
                            best->words()));
}

}  // namespace shapeid::diagnosis
