#include "shapeid/models/cells.hpp"

#include <cmath>

namespace shapeid {

double rms_stretch(const Eigen::Matrix3d& linear, const Eigen::Matrix3d& mean_vvT) {
  return std::sqrt((linear * mean_vvT * linear.transpose()).trace());
}

}  // namespace shapeid
