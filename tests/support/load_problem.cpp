#include "shapeid/tests/support/load_problem.hpp"

#include <Eigen/Geometry>

namespace shapeid::test {

double Draw::sign() { return between(-1.0, 1.0); }

double Draw::between(double lower, double upper) {
  constexpr int spare_bits = 64 - 53;
  constexpr double step = 1.0 / (std::uint64_t{1} << 53);
  return lower + static_cast<double>(engine_() >> spare_bits) * step * (upper - lower);
}

double Draw::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += between(0.0, 1.0);
  return sum;
}

Eigen::Vector3d Draw::vector(double bound) {
  const double x = sign(), y = sign(), z = sign();
  return bound * Eigen::Vector3d(x, y, z);
}

Eigen::Vector3d Draw::sides(double lower, double upper) {
  const double x = between(lower, upper), y = between(lower, upper), z = between(lower, upper);
  return {x, y, z};
}

Eigen::Matrix<double, 6, 10> body_rows(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha,
                                       const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 6, 10> Y;
  for (int j = 0; j < 10; ++j) {
    const InertialParameters unit{Vector10::Unit(j)};
    const Eigen::Vector3d h = unit.first_moment();
    const Eigen::Matrix3d I = unit.tensor();
    Y.col(j).head<3>() = unit.mass() * a + alpha.cross(h) + omega.cross(omega.cross(h));
    Y.col(j).tail<3>() = I * alpha + omega.cross(I * omega) + h.cross(a);
  }
  return Y;
}

MassProblem load_window(Draw& draw, int samples, const InertialParameters& truth,
                        double relative_noise) {
  MassProblem problem;
  problem.Y.resize(Eigen::Index{6} * samples, 10);
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector3d omega = draw.vector(2.0), alpha = draw.vector(20.0),
                          a = Eigen::Vector3d(0.0, 0.0, 9.81) + draw.vector(4.0);
    problem.Y.middleRows<6>(Eigen::Index{6} * i) = body_rows(omega, alpha, a);
  }
  problem.F = problem.Y * truth.values;
  // Forces and moments each have their own size of noise, and the weight that goes with it.
  problem.W = Eigen::VectorXd::Ones(problem.F.size());
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (int i = 0; i < samples; ++i) {
    squares += Eigen::Vector2d(problem.F.segment<3>(Eigen::Index{6} * i).squaredNorm(),
                               problem.F.segment<3>(6 * i + 3).squaredNorm());
  }
  const Eigen::Vector2d sizes = (squares / (3.0 * samples)).cwiseSqrt();
  for (Eigen::Index row = 0; row < problem.F.size(); ++row) {
    const double size = sizes[row % 6 / 3];
    problem.F[row] += relative_noise * size * draw.normal();
    problem.W[row] = 1.0 / (size * size);
  }
  problem.mass_bound = 10.0 * truth.mass();
  return problem;
}

InertialParameters cuboid_body(double mass, const Eigen::Vector3d& centre,
                               const Eigen::Vector3d& sides) {
  const Eigen::Vector3d squares = sides.cwiseAbs2();
  const Eigen::Vector3d moments =
      mass / 12.0 * (Eigen::Vector3d::Constant(squares.sum()) - squares);
  return from_centre(mass, centre, moments.asDiagonal());
}

void fill_with_cuboids(MassProblem& problem, const Eigen::Vector3d& lower,
                       const Eigen::Vector3d& upper, const Eigen::Vector3i& counts) {
  const Eigen::Vector3d sides = (upper - lower).cwiseQuotient(counts.cast<double>());
  const Eigen::Index n = counts.prod();
  problem.U.resize(10, n);
  problem.V = Eigen::VectorXd::Constant(n, sides.prod());
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::Index row = j / counts.x(), layer = row / counts.y();
    const Eigen::Vector3d place(static_cast<double>(j % counts.x()),
                                static_cast<double>(row % counts.y()), static_cast<double>(layer));
    const Eigen::Vector3d centre =
        lower + sides.cwiseProduct(place + Eigen::Vector3d::Constant(0.5));
    problem.U.col(j) = cuboid_body(1.0, centre, sides).values;
  }
}

}  // namespace shapeid::test
