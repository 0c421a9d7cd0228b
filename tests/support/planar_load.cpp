#include "shapeid/tests/support/planar_load.hpp"

#include <cmath>

#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::test {

ModelWithRows planar_load(std::uint64_t seed, double relative_noise) {
  constexpr Eigen::Index samples = 40, rows = 3;
  Draw draw(seed);
  ModelWithRows given;
  given.model = one_cuboid({0.05, 0.02, 0.1}, {0.4, 1.6, 0.3});
  const Vector10 truth = cuboid_body(1.0, {0.13, -0.04, 0.07}, {0.04, 0.04, 0.04}).values;
  MassProblem& p = given.problem;
  p.Y.resize(rows * samples, 10);
  for (Eigen::Index i = 0; i < samples; ++i) {
    const Eigen::Vector3d omega(0.0, 3.0 * draw.sign(), 0.0), alpha(0.0, 20.0 * draw.sign(), 0.0);
    const Eigen::Vector3d a(5.0 * draw.sign(), 0.0, 9.81 + 5.0 * draw.sign());
    p.Y.middleRows<rows>(rows * i) = body_rows(omega, alpha, a)({0, 2, 4}, Eigen::all);
  }
  p.F = p.Y * truth;
  const double size = p.F.norm() / std::sqrt(static_cast<double>(p.F.size()));
  for (double& f : p.F) f += relative_noise * size * draw.normal();
  p.W = Eigen::VectorXd::Ones(p.F.size());
  use_shapes(p, given.model, given.expected_mass);
  return given;
}

}  // namespace shapeid::test
