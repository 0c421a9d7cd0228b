// Optima and their floors, against solvers that share nothing with them.
#include <gtest/gtest.h>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"
#include "shapeid/tests/experiments/methods/cone.hpp"
#include "shapeid/tests/experiments/methods/division_floor.hpp"
#include "shapeid/tests/experiments/methods/lowest_point.hpp"
#include "shapeid/tests/experiments/studies/contest.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::experiments {
namespace {

constexpr double length = 0.1;  // m

/// Rows of a body in random motion, with noise of a tenth of their size.
DataTerm noisy_window(std::uint64_t seed) {
  test::Draw draw(seed);
  const InertialParameters truth = test::cuboid_body(1.0, {0.05, -0.02, 0.03}, {0.2, 0.1, 0.004});
  const MassProblem p = test::load_window(draw, 8, truth, 0.1);
  Eigen::MatrixXd YF(p.Y.rows(), 11);
  YF << p.Y, p.F;
  YF = p.W.cwiseSqrt().asDiagonal() * YF;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(YF);
  return DataTerm(qr.matrixQR().topRows<11>().triangularView<Eigen::Upper>().toDenseMatrix());
}

/// A body that can exist, drawn at random: a few points.
Vector10 some_body(test::Draw& draw) {
  Vector10 Phi = Vector10::Zero();
  for (int i = 0; i < 5; ++i) {
    const double mass = draw.between(0.0, 0.5);
    Phi += from_centre(mass, draw.vector(0.2), Eigen::Matrix3d::Zero()).values;
  }
  return Phi;
}

TEST(Cones, ValueAndFloorMeetAndNoBodyIsBelow) {
  test::Draw draw(7);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DataTerm f = noisy_window(seed);
    const ConeOptimum full = least_over(consistent_bodies(length), f);
    const ConeOptimum positive = least_over(positive_bodies(length), f);
    EXPECT_LT(full.value - full.floor, 1e-11 * f.size());
    EXPECT_LT(positive.value - positive.floor, 1e-11 * f.size());
    EXPECT_LE(full.floor, full.value);
    EXPECT_LE(positive.floor, full.value);
    EXPECT_EQ(why_impossible({full.Phi}), std::nullopt);
    for (int i = 0; i < 50; ++i) EXPECT_LE(full.floor, f.value(some_body(draw)));
    // Steps toward other bodies go up: the gradient is in the dual cone.
    for (int i = 0; i < 50; ++i) {
      const Vector10 nearer = 0.999 * full.Phi + 0.001 * some_body(draw);
      EXPECT_LE(full.floor, f.value(nearer));
    }
  }
}

TEST(Cones, ReachTheEdgeThatSmoothParametersDoNot) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const Setting setting = base_setting(quadruped);
  const auto ceres = make_log_cholesky(setting, Effort::hard);
  int above = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DataTerm f = noisy_window(seed);
    const Answer smooth = ceres->answer(f);
    const ConeOptimum full = least_over(consistent_bodies(setting.length), f);
    EXPECT_GE(smooth.value, full.floor);
    if (smooth.value > 1.0001 * full.value) ++above;
  }
  EXPECT_LT(above, 20);  // where the optimum is inside, both find it
}

TEST(Cones, FreeOptimumInsideIsFound) {
  // Without noise the truth is the optimum of every set that holds it.
  test::Draw draw(3);
  const InertialParameters truth = test::cuboid_body(2.0, {0.05, -0.02, 0.03}, {0.2, 0.1, 0.1});
  const MassProblem p = test::load_window(draw, 8, truth, 0.0);
  Eigen::MatrixXd YF(p.Y.rows(), 11);
  YF << p.Y, p.F;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(YF);
  const DataTerm f(qr.matrixQR().topRows<11>().triangularView<Eigen::Upper>().toDenseMatrix());
  const ConeOptimum full = least_over(consistent_bodies(length), f);
  constexpr double of_barrier = 1e-11;  // the last mu times the order of the matrix, twice over
  EXPECT_LT(full.value, of_barrier * f.size());
}

TEST(LowestPoint, IsThatOfTheExactSearchOfTheCertificate) {
  const BodyModel base = test::bundled_quadruped().base;
  test::Draw draw(5);
  for (int i = 0; i < 20; ++i) {
    Vector10 z;
    for (double& entry : z) entry = draw.sign();
    z.tail<6>() *= 100.0;  // m^-2: the base is a tenth of a metre wide
    double lowest = std::numeric_limits<double>::infinity();
    for (const SoughtShape& s : base.shapes) {
      const auto q = certificate::cost_of_point(certificate::exact(z));
      lowest = std::min(lowest, certificate::lowest_in(q, s.shape).value.get_d());
    }
    const LowestPoint found = lowest_point(base, z);
    // Coordinates are turned and stretched before the search; the certificate rounds the sides of
    // its prism outward.
    const double size = z.cwiseAbs().sum();
    EXPECT_LT(test::scaled(found.value - lowest, size, 10), 1e8) << found.value - lowest;
    const Vector10 unit = from_centre(1.0, found.point, Eigen::Matrix3d::Zero()).values;
    EXPECT_LT(test::scaled(z.dot(unit) - found.value, size, 10), test::few_hundred_eps);
  }
}

TEST(DivisionLimit, IsBelowEveryDivision) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const Setting setting = base_setting(quadruped);
  const auto ours = make_shapes(setting.shapes), divided = make_divided(setting, 0.01, 300);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const DataTerm f = noisy_window(seed);
    const DivisionLimit limit = limit_of_divisions(setting.shapes, f, 1e-3);
    const Answer whole = ours->answer(f), parts = divided->answer(f);
    EXPECT_LE(limit.floor, parts.value);
    EXPECT_LE(parts.value, whole.value);
    EXPECT_LE(limit.value - limit.floor, 1e-3 * limit.value);
    EXPECT_LE(least_over(consistent_bodies(setting.length), f).floor, limit.value);
  }
}

}  // namespace
}  // namespace shapeid::experiments
