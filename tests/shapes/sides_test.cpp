// Lengths of a sector's sides against arcs worked out by hand: with no stretch they are the radius
// (at the outer end) times the angle.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "shapeid/models/cells.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

/// A radius of 0.3 m, somewhere and turned.
Eigen::Affine3d turned_and_enlarged() {
  return Eigen::Translation3d(0.2, -0.5, 0.7) *
         Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()) *
         Eigen::UniformScaling<double>(0.3);
}

TEST(Sides, OfASectorOfABallAreItsArcs) {
  // The polar angle passes the equator, where the azimuth's arc is longest.
  const Ellipsoid sector{turned_and_enlarged(), {{0.5, 0.9, -0.4}, {0.8, 2.1, 0.6}}};
  const double outer = 0.3 * 0.8;
  const Eigen::Vector3d arcs(0.3 * 0.3, outer * 1.2, outer * 1.0);
  EXPECT_LT(test::scaled_difference(side_lengths(sector), arcs, 3), test::few_hundred_eps);

  // It does not, and the widest circle of latitude is at the end nearer to it.
  const Ellipsoid northern{turned_and_enlarged(), {{0.5, 0.3, -0.4}, {0.8, 0.7, 0.6}}};
  const Eigen::Vector3d northern_arcs(0.3 * 0.3, outer * 0.4, outer * std::sin(0.7));
  EXPECT_LT(test::scaled_difference(side_lengths(northern), northern_arcs, 3),
            test::few_hundred_eps);
}

TEST(Sides, OfASectorOfACylinderAreItsArcs) {
  const Cylinder sector{turned_and_enlarged(), {{0.5, -0.4, -0.2}, {0.8, 0.6, 0.5}}};
  const Eigen::Vector3d arcs(0.3 * 0.3, 0.3 * 0.8 * 1.0, 0.3 * 0.7);
  EXPECT_LT(test::scaled_difference(side_lengths(sector), arcs, 3), test::few_hundred_eps);
}

/// Mean over the cell, by Simpson's rule in the cosine of the polar angle and in the azimuth.
template <typename Function>
double mean_over(const Cell& cell, const Function& f) {
  constexpr int intervals = 100;
  const auto weight = [](int k) {
    return (k == 0 || k == intervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0) / (3.0 * intervals);
  };
  const double from = std::cos(cell.lower[1]), to = std::cos(cell.upper[1]);
  double sum = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double polar = std::acos(from + (to - from) * i / intervals);
    for (int k = 0; k <= intervals; ++k) {
      const double azimuth = cell.lower[2] + (cell.upper[2] - cell.lower[2]) * k / intervals;
      sum += weight(i) * weight(k) * f(polar, azimuth);
    }
  }
  return sum;
}

// In a stretched frame: times the root mean square of the stretch along the coordinate.
TEST(Sides, OfAStretchedSectorAreMeans) {
  const Eigen::Affine3d frame = turned_and_enlarged() * Eigen::Scaling(1.0, 2.5, 0.4);
  const Ellipsoid sector{frame, {{0.5, 0.4, -0.3}, {0.8, 1.3, 1.6}}};
  const auto stretch = [&](const auto& direction) {
    return std::sqrt(mean_over(sector.cell, [&](double polar, double azimuth) {
      return (frame.linear() * direction(polar, azimuth)).squaredNorm();
    }));
  };
  const Eigen::Vector3d means(
      stretch([](double p, double a) {
        return Eigen::Vector3d(std::sin(p) * std::cos(a), std::sin(p) * std::sin(a), std::cos(p));
      }),
      stretch([](double p, double a) {
        return Eigen::Vector3d(std::cos(p) * std::cos(a), std::cos(p) * std::sin(a), -std::sin(p));
      }),
      stretch([](double, double a) { return Eigen::Vector3d(-std::sin(a), std::cos(a), 0.0); }));
  // The widest circle of latitude is at 1.3 rad.
  const Eigen::Vector3d arcs(0.3, 0.8 * 0.9, 0.8 * std::sin(1.3) * 1.9);
  constexpr double simpson = 1e-7;  // (width / intervals)^4 and some derivatives
  EXPECT_LT((side_lengths(sector) - arcs.cwiseProduct(means)).norm(), simpson * arcs.norm());

  const Cylinder part{frame, {{0.5, -0.3, -0.2}, {0.8, 1.6, 0.5}}};
  const auto around = [&](bool outward) {
    return std::sqrt(mean_over(sector.cell, [&](double, double a) {
      const Eigen::Vector3d out(std::cos(a), std::sin(a), 0.0);
      const Eigen::Vector3d along(-std::sin(a), std::cos(a), 0.0);
      return (frame.linear() * (outward ? out : along)).squaredNorm();
    }));
  };
  const Eigen::Vector3d of_cylinder(0.3 * around(true), 0.8 * 1.9 * around(false),
                                    0.7 * frame.linear().col(2).norm());
  EXPECT_LT((side_lengths(part) - of_cylinder).norm(), simpson * of_cylinder.norm());
}

}  // namespace
}  // namespace shapeid
