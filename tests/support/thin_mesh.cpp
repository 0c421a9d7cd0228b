#include "shapeid/tests/support/thin_mesh.hpp"

#include <Eigen/Geometry>

#include <random>
#include <utility>
#include <vector>

namespace shapeid::test {

Shape flat_tetrahedron(double thin, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto some = [&] { return uniform(random); };
  std::vector<Eigen::Vector3d> v;
  v.reserve(4);
  for (int i = 0; i < 4; ++i) v.emplace_back(some(), some(), some() * thin);
  if ((v[1] - v[0]).cross(v[2] - v[0]).dot(v[3] - v[0]) > 0.0) std::swap(v[0], v[1]);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(some(), some(), some(), some()).normalized().matrix();
  pose.translation() = Eigen::Vector3d(some(), some(), some());
  return make_mesh(v, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}}, pose);
}

}  // namespace shapeid::test
