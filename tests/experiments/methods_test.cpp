// Optima and their floors, against solvers that share nothing with them.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <variant>

#include "shapeid/models/inertia.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"
#include "shapeid/tests/experiments/data/load_data.hpp"
#include "shapeid/tests/experiments/methods/cone.hpp"
#include "shapeid/tests/experiments/methods/division_floor.hpp"
#include "shapeid/tests/experiments/methods/lowest_point.hpp"
#include "shapeid/tests/experiments/studies/contest.hpp"
#include "shapeid/tests/experiments/studies/torque_scale.hpp"
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
  EXPECT_GT(above, 0);
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

/// Slopes of a polynomial with entries of one size over the base, which is a tenth of a metre wide.
Vector10 some_slopes(test::Draw& draw) {
  Vector10 z;
  for (double& entry : z) entry = draw.sign();
  z.tail<6>() *= 100.0;
  return z;
}

Vector10 point_at(const Eigen::Vector3d& x) {
  return from_centre(1.0, x, Eigen::Matrix3d::Zero()).values;
}

template <typename Kind>
BodyModel base_of() {
  BodyModel model = test::bundled_quadruped().base;
  std::erase_if(model.shapes,
                [](const SoughtShape& s) { return !std::holds_alternative<Kind>(s.shape); });
  return model;
}

TEST(LowestPoint, InCuboidsIsThatOfTheExactSearch) {
  const BodyModel cuboids = base_of<Cuboid>();
  ASSERT_EQ(cuboids.shapes.size(), 7U);
  test::Draw draw(5);
  for (int i = 0; i < 100; ++i) {
    const Vector10 z = some_slopes(draw);
    const auto q = certificate::cost_of_point(certificate::exact(z));
    double lowest = std::numeric_limits<double>::infinity();
    for (const SoughtShape& s : cuboids.shapes) {
      lowest = std::min(lowest, certificate::lowest_in(q, s.shape).value.get_d());
    }
    const LowestPoint found = lowest_point(cuboids, z);
    const double size = z.cwiseAbs().sum();
    EXPECT_LT(std::abs(test::scaled(found.value - lowest, size, 10)), test::few_hundred_eps);
    EXPECT_LT(std::abs(test::scaled(z.dot(point_at(found.point)) - found.value, size, 10)),
              test::few_hundred_eps);
  }
}

TEST(LowestPoint, InCylindersIsBelowAllTheirPointsAndNotFarOutside) {
  const BodyModel cylinders = base_of<Cylinder>();
  ASSERT_EQ(cylinders.shapes.size(), 4U);
  constexpr double corner = 0.045 * 0.00215;  // m: radius times 1 / cos(pi / 48) - 1, and a little
  test::Draw draw(6);
  for (int i = 0; i < 100; ++i) {
    const Vector10 z = some_slopes(draw);
    const LowestPoint found = lowest_point(cylinders, z);
    bool near_one = false;
    for (const SoughtShape& s : cylinders.shapes) {
      near_one = near_one || contains(s.shape, found.point, corner);
      const Eigen::Affine3d frame = std::get<Cylinder>(s.shape).frame;
      for (int k = 0; k < 50; ++k) {
        const double angle = draw.between(0.0, 6.28), r = std::sqrt(draw.between(0.0, 1.0));
        const Eigen::Vector3d in(r * std::cos(angle), r * std::sin(angle), 0.5 * draw.sign());
        EXPECT_LE(found.value, z.dot(point_at(frame * in)));
      }
    }
    EXPECT_TRUE(near_one) << found.point.transpose();
  }
}

TEST(ScaledRows, AreTheWindowsRowsAtScaleOne) {
  const test::Quadruped quadruped = test::bundled_quadruped();
  const BodyModel area = load_area(quadruped.robot);
  const auto motion = simulated(quadruped.robot, {gaits().front(), 0.1, 1, Load{}});
  const std::vector<Sample> samples = exact(motion, 0.1);
  const DataTerm window = whole(quadruped.robot, area, samples);
  const ScaledRows rows(quadruped.robot, area, samples);
  const Vector10 load = inertia_of(Load{}).values;
  const Eigen::MatrixXd H = window.R().transpose() * window.R();
  EXPECT_LT(test::scaled_difference(rows.at(1.0).R().transpose() * rows.at(1.0).R(), H,
                                    std::ssize(samples)),
            test::few_hundred_eps);
  // Half the torque at twice the scale is the same robot.
  EXPECT_LT(rows.rms(1.0, load), 1e-3 * rows.rms(1.0, Vector10::Zero()));
  std::vector<Sample> halved = samples;
  for (Sample& s : halved) s.tau *= 0.5;
  const ScaledRows other(quadruped.robot, area, halved);
  const double before = rows.rms(1.0, Vector10::Zero()), after = other.rms(2.0, Vector10::Zero());
  EXPECT_LT(std::abs(test::scaled(0.5 * before - after, before, std::ssize(samples))),
            test::few_hundred_eps);
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
