// Pictures of what a diagnosis leaves of the torque, drawn by gnuplot as SVG.
#pragma once

#include <string>

#include "shapeid/app/diagnosis_run.hpp"

namespace shapeid::app {

/// Residual of every joint with zero torque, the given model and the found one, rms, and its noise
/// floor, on a logarithmic axis. Empty if no joint has an error.
[[nodiscard]] std::string errors_picture(const DiagnosisRun& run, const Robot& robot);

/// Logged torque with both predictions, and both residuals below, over the seconds of the test
/// motion in which the joint moves most. Empty if it stands still there, as friction at rest holds
/// any torque.
[[nodiscard]] std::string torque_picture(const DiagnosisRun& run, const Robot& robot, int joint);

/// What is left after, over the joint's velocity, position, predicted torque, and time. Empty
/// likewise.
[[nodiscard]] std::string scatter_picture(const DiagnosisRun& run, const Robot& robot, int joint);

/// Autocorrelation of the residual before and after, with the band of white noise, every joint.
[[nodiscard]] std::string autocorrelation_picture(const DiagnosisRun& run, const Robot& robot);

}  // namespace shapeid::app
