// What the reference makes of a sample, and how exactly that is defined at all.
#pragma once

#include <Eigen/Core>

#include <string>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// Of rows [Y F], free of contact forces and weighted, only these are defined: Q2 is up to a
/// rotation. They add up over samples.
struct ExpectedRows {
  Eigen::MatrixXd gram;      ///< [Y F]^T [Y F] by the reference
  Eigen::MatrixXd rounding;  ///< what an error of eps in everything that is read comes to
};

/// Columns count by the whole wrenches that they are made of, projection by the condition of the
/// forces' columns; where six rows may be enough, by that of the legs as well.
[[nodiscard]] ExpectedRows expected_rows(const Robot& robot, const BodyModel& model,
                                         ContactTreatment contacts, const Eigen::VectorXd& weight,
                                         const Sample& sample);

/// Empty if `gram` is the expected one to a few hundred roundings; else the first entry that
/// differs, and the input.
[[nodiscard]] std::string first_difference(const Eigen::MatrixXd& gram,
                                           const ExpectedRows& expected, const Robot& robot,
                                           const Sample& sample);

}  // namespace shapeid::test
