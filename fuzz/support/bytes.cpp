#include "shapeid/fuzz/support/bytes.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace shapeid::fuzz {

double Bytes::unit() {
  const int high = byte(), low = byte();
  return (256 * high + low - 32768) / 32768.0;
}

double Bytes::wild(int decades) {
  const int kind = byte() % 8;
  if (kind == 0) return 0.0;
  if (kind == 1) return 1.0;
  const double value = unit();
  // Half the numbers are of ordinary size: among wild ones alone all but the largest is rounding.
  return kind < 5 ? value : value * std::pow(10.0, decades * unit());
}

Eigen::VectorXd Bytes::units(Eigen::Index size) {
  Eigen::VectorXd values(size);
  for (double& value : values) value = unit();
  return values;
}

Eigen::Vector3d Bytes::direction() {
  const Eigen::Vector3d v = vector(1.0);
  return v.isZero(0.0) ? Eigen::Vector3d::UnitZ() : v.normalized();
}

Eigen::Matrix3d Bytes::rotation() {
  constexpr double half_turn = 3.14159265358979323846;
  const Eigen::Vector3d axis = direction();
  return Eigen::AngleAxisd(half_turn * unit(), axis).toRotationMatrix();
}

}  // namespace shapeid::fuzz
