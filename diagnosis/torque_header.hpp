// C++ that predicts joint torque with an identified model: one header without dependencies.
#pragma once

#include <string>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// The text of a header that defines
///   void shapeid_model::predict(const double* q, const double* dq, const double* ddq,
///                               const double* base, double* tau,
///                               const double* contact = nullptr);
/// tau (n, N m) for joint positions, velocities and accelerations (n each) and the base's nine
/// numbers: gyro, its derivative, specific force, in base axes (null: fixed and upright).
/// `contact` is J^T f at the joints (n) of the contact forces f on the robot, with J of the model's
/// own geometry (null: nothing touches). Effects that are not of joints and links, that change the
/// log's signals or come at some moment are left out, and named in a comment. A model with an
/// effect that needs the load's rate (torque_lag) has instead
///   constexpr double shapeid_model::around_times[];
///   void shapeid_model::predict(const Motion& now, const Motion* around, double* tau);
/// of the motion now and at those times, s from now, and the same of one motion and the rate.
[[nodiscard]] std::string torque_header(const Robot& robot, const RichModel& model);

}  // namespace shapeid::diagnosis
