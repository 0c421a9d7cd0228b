// A load on one free-floating link, without a robot: rows of a single rigid body in random motion.
#pragma once

#include <cstdint>
#include <random>

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::test {

/// Numbers that are the same on every platform (the standard's distributions are not).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}

  /// Even in [-1, 1).
  double sign();
  /// Even in [lower, upper).
  double between(double lower, double upper);
  /// Sum of twelve even numbers: mean 0, variance 1, close to normal.
  double normal();
  Eigen::Vector3d vector(double bound);
  /// Lengths of three sides, each even in [lower, upper).
  Eigen::Vector3d sides(double lower, double upper);

 private:
  std::mt19937_64 engine_;
};

/// Force (N) and moment about the origin (N m) of a body per unit of its ten parameters, all in
/// body axes: 6 x 10. Newton and Euler about a moving point:
///   f = m a + alpha x h + omega x (omega x h),  n = I alpha + omega x (I omega) + h x a,
/// with a the specific force at the origin (m/s^2), h the first moment.
[[nodiscard]] Eigen::Matrix<double, 6, 10> body_rows(const Eigen::Vector3d& omega,
                                                     const Eigen::Vector3d& alpha,
                                                     const Eigen::Vector3d& a);

/// `samples` random motions of a legged robot's trunk (rad/s, rad/s^2, m/s^2 with gravity): rows
/// that `truth` explains but for noise of the given relative size. U and V are left empty.
[[nodiscard]] MassProblem load_window(Draw& draw, int samples, const InertialParameters& truth,
                                      double relative_noise);

/// Unit parameters and volumes of nx x ny x nz equal cuboids that fill a box: what deep divisions
/// lead to.
void fill_with_cuboids(MassProblem& problem, const Eigen::Vector3d& lower,
                       const Eigen::Vector3d& upper, const Eigen::Vector3i& counts);

/// A solid cuboid, uniform, sides along the axes.
[[nodiscard]] InertialParameters cuboid_body(double mass, const Eigen::Vector3d& centre,
                                             const Eigen::Vector3d& sides);

}  // namespace shapeid::test
