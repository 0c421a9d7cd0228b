// C++ that predicts joint torque with an identified model: one header without dependencies.
#pragma once

#include <string>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// The text of a header that defines
///   void shapeid_model::predict(const double* q, const double* dq, const double* ddq,
///                               const double* base, double* tau);
/// tau (n, N m) for joint positions, velocities and accelerations (n each) and the base's nine
/// numbers: gyro, its derivative, specific force, in base axes (null: fixed and upright). Contact
/// forces f on the robot are not in it: subtract J^T f. Effects that change no joint torque, or
/// move the log in time, are named in a comment. A model with an effect that needs the load's rate
/// (torque_lag) has instead
///   void shapeid_model::predict(const Motion& before, const Motion& now, const Motion& after,
///                               double* tau);
/// of the motion now and neighbour_step() to either side, and the same of one motion and the rate.
[[nodiscard]] std::string torque_header(const Robot& robot, const RichModel& model);

}  // namespace shapeid::diagnosis
