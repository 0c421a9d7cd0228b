// One sample's rows of equation (1), for the links that are sought.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/contact_treatment.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::reference {

/// Y Phi - F = J^T f, in generalised order, not weighted yet.
struct SampleRows {
  Eigen::MatrixXd Y;  ///< dof x (10 per free link)
  Eigen::VectorXd F;  ///< dof: applied force, less known links, plus measured forces
  Eigen::MatrixXd J;  ///< contact rows x dof: what unknown forces act through; perhaps no rows
};

/// `known`: 10 per link of the robot, stacked. Throws Refusal ("no-contact-forces") if forces
/// should be measured and are not.
[[nodiscard]] SampleRows sample_rows(const Robot& robot, const Eigen::VectorXd& known,
                                     const std::vector<int>& free_links, ContactTreatment contacts,
                                     const Sample& sample);

}  // namespace shapeid::reference
