#include "shapeid/reference/triangle.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace shapeid::reference {

Eigen::MatrixXd triangle(const Eigen::MatrixXd& rows) {
  const Eigen::Index kept = std::min(rows.rows(), rows.cols());
  if (kept == 0) return Eigen::MatrixXd(0, rows.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  return qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd stacked(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd rows(above.rows() + below.rows(), above.cols());
  rows << above, below;
  return rows;
}

}  // namespace shapeid::reference
