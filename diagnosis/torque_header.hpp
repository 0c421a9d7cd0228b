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
/// forces are not in it: add J^T f. Effects that change no joint torque, or look at other times,
/// are named in a comment.
[[nodiscard]] std::string torque_header(const Robot& robot, const RichModel& model);

}  // namespace shapeid::diagnosis
