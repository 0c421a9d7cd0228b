#include "shapeid/reference/sample_rows.hpp"

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"

namespace shapeid::reference {

SampleRows sample_rows(const Robot& robot, const Eigen::VectorXd& known,
                       const std::vector<int>& free_links, ContactTreatment contacts,
                       const Sample& sample) {
  const Eigen::MatrixXd Y = regressor(robot, sample);
  SampleRows rows;
  rows.Y.resize(Y.rows(), 10 * static_cast<Eigen::Index>(free_links.size()));
  Eigen::Index column = 0;
  for (const int link : free_links) {
    rows.Y.middleCols<10>(column) = Y.middleCols<10>(Eigen::Index{10} * link);
    column += 10;
  }
  rows.F = applied_force(robot, sample) - Y * known;
  if (contacts == ContactTreatment::measured) {
    rows.F += measured_contact_force(robot, sample);  // (4)
  }
  rows.J = contacts == ContactTreatment::project ? contact_jacobian(robot, sample)
                                                 : Eigen::MatrixXd(0, robot.dof());
  return rows;
}

}  // namespace shapeid::reference
