// Laws of division, the same for all kinds: parts hold what they should and add up to the whole, at
// any depth.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/shapes/quadrature.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::own_size;
using test::reach;
using test::scaled;

/// What eps is relative to in the volume below a cut: cut coordinates round at their own size, not
/// at the width of the cell.
double volume_scale(const Shape& shape, int axis) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.cell; }) {
          const double bound = std::max(std::abs(s.cell.lower[axis]), std::abs(s.cell.upper[axis]));
          return volume(shape) * (1.0 + bound / (s.cell.upper[axis] - s.cell.lower[axis]));
        } else {
          return volume(shape) * test::volume_rounding(shape);
        }
      },
      shape);
}

/// Volumes add up, first and second moments as well: u = (V1/V) u1 + (V2/V) u2. Once about the
/// link origin, where eps is relative to the distance from it, and once about the part's own
/// centroid, where a small part cannot hide behind that distance.
void check_sums(const Shape& whole, const std::array<Shape, 2>& parts) {
  const Moments m = moments(whole);
  const double size = own_size(whole);
  const double far = reach(whole);
  const double rounding = test::volume_rounding(whole);

  double sum = 0.0;
  Vector10 u = Vector10::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Shape& part : parts) {
    const Moments p = moments(part);
    const double share = p.volume / m.volume;
    sum += p.volume;
    u += share * unit_parameters(part).values;
    const Eigen::Vector3d offset = p.centroid - m.centroid;
    covariance += share * (p.covariance + offset * offset.transpose());
  }
  const Vector10 error = u - unit_parameters(whole).values;
  RC_ASSERT(scaled(std::abs(sum - m.volume), m.volume * rounding, 2) < few_hundred_eps);
  RC_ASSERT(scaled(std::abs(error[0]), rounding, 2) < few_hundred_eps);
  RC_ASSERT(scaled(error.segment(1, 3).norm(), far * rounding, 3) < few_hundred_eps);
  RC_ASSERT(scaled(error.tail(6).norm(), far * far * rounding, 6) < few_hundred_eps);
  RC_ASSERT(scaled((covariance - m.covariance).norm(), size * (size + far) * rounding, 9) <
            few_hundred_eps);
}

RC_GTEST_PROP(Division, PartsAddUpToTheWhole, ()) {
  const Shape whole = *test::solid();
  const test::Cut cut = *test::cut();
  const auto [lower, upper] = divide(whole, cut.axis, cut.fraction);
  check_sums(whole, {lower, upper});
}

RC_GTEST_PROP(Division, LowerPartHoldsItsFraction, ()) {
  const Shape whole = *test::solid();
  const test::Cut cut = *test::cut();
  const auto [lower, upper] = divide(whole, cut.axis, cut.fraction);
  const double scale = volume_scale(whole, cut.axis);
  RC_ASSERT(scaled(std::abs(volume(lower) - cut.fraction * volume(whole)), scale, 1) <
            few_hundred_eps);
  RC_ASSERT(scaled(std::abs(volume(upper) - (1.0 - cut.fraction) * volume(whole)), scale, 1) <
            few_hundred_eps);
}

RC_GTEST_PROP(Division, PartsAreOfTheSameKindAndWellFormed, ()) {
  const Shape whole = *test::solid();
  const test::Cut cut = *test::cut();
  const auto [lower, upper] = divide(whole, cut.axis, cut.fraction);
  for (const Shape& part : {lower, upper}) {
    RC_ASSERT(kind_name(part) == kind_name(whole));
    RC_ASSERT(!why_malformed(part));
    RC_ASSERT(divisible(part));
    RC_ASSERT(!why_impossible(unit_parameters(part)));
  }
}

RC_GTEST_PROP(Division, DefaultHalvesTheVolume, ()) {
  const Shape whole = *test::solid();
  const auto [lower, upper] = divide(whole);
  const double scale =
      std::max({volume_scale(whole, 0), volume_scale(whole, 1), volume_scale(whole, 2)});
  RC_ASSERT(scaled(std::abs(volume(lower) - volume(upper)), scale, 2) < few_hundred_eps);
  check_sums(whole, {lower, upper});
}

// Twenty halvings leave a millionth of the volume. The part's moments are still right to its own
// size, and the parts left behind on the way still make up the whole.
RC_GTEST_PROP(Division, TwentyHalvingsDoNotDrift, ()) {
  constexpr int depth = 20;
  const Shape whole = *test::solid();
  const auto turns = *rc::gen::container<std::vector<bool>>(depth, rc::gen::arbitrary<bool>());
  const double far = reach(whole);

  Shape part = whole;
  double left_volume = 0.0;
  Vector10 left = Vector10::Zero();
  double rounding = 1.0;
  for (const bool turn : turns) {
    for (int axis = 0; axis < 3; ++axis) {
      rounding = std::max(rounding, volume_scale(part, axis) / volume(part));
    }
    auto [lower, upper] = divide(part);
    if (turn) std::swap(lower, upper);
    left_volume += volume(upper);
    left += volume(upper) / volume(whole) * unit_parameters(upper).values;
    part = lower;
    RC_ASSERT(!why_malformed(part));
    RC_ASSERT(!why_impossible(unit_parameters(part)));
  }

  const double millionth = std::ldexp(volume(whole), -depth);
  RC_ASSERT(scaled(std::abs(volume(part) - millionth), millionth * rounding, depth) <
            few_hundred_eps);

  const Moments here = moments(part);
  const Moments there = test::integrated(part);
  RC_ASSERT(scaled((here.covariance - there.covariance).norm(), there.covariance.trace(), 9) <
            few_hundred_eps);

  const double share = volume(part) / volume(whole);
  const Vector10 error =
      left + share * unit_parameters(part).values - unit_parameters(whole).values;
  const double of_whole = test::volume_rounding(whole);
  RC_ASSERT(scaled(std::abs(left_volume + volume(part) - volume(whole)), volume(whole) * of_whole,
                   depth) < few_hundred_eps);
  RC_ASSERT(scaled(error.segment(1, 3).norm(), far * of_whole, depth) < few_hundred_eps);
  RC_ASSERT(scaled(error.tail(6).norm(), far * far * of_whole, depth) < few_hundred_eps);
}

// Cuts wherever they fall, not only the sensible ones: slivers are bodies too.
RC_GTEST_PROP(Division, ArbitraryDescentsStayBodies, ()) {
  Shape part = *test::solid();
  const auto cuts = *rc::gen::container<std::vector<test::Cut>>(12, test::cut());
  for (const test::Cut& cut : cuts) {
    const auto [lower, upper] = divide(part, cut.axis, cut.fraction);
    check_sums(part, {lower, upper});
    part = cut.upper ? upper : lower;
    RC_ASSERT(!why_malformed(part));
    RC_ASSERT(!why_impossible(unit_parameters(part)));
  }
}

// Halves of halves end with a refusal, not with a part that is none.
TEST(Division, EndsWhereDoublesDo) {
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.3, -0.7, 0.5) *
                               Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized()));
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(8);
  for (int k = 0; k < 8; ++k) {
    corners.emplace_back(0.1 * (k & 1), 0.2 * ((k >> 1) & 1), 0.3 * (k >> 2));
  }
  for (const Shape& whole :
       {make_cuboid({0.1, 0.2, 0.3}, pose), make_cylinder(0.1, 0.3, pose),
        make_ellipsoid({0.1, 0.2, 0.3}, pose), make_convex_hull(corners, pose)}) {
    for (int axis = 0; axis < 3; ++axis) {
      Shape part = whole;
      int cuts = 0;
      // A corner shrinks in all directions at once, a pole as the square of its angle.
      constexpr int more_than_digits = 3 * 80;
      try {
        for (; cuts < more_than_digits; ++cuts) {
          part = divide(part, axis, 0.5).second;
          ASSERT_FALSE(why_malformed(part)) << kind_name(whole) << " " << axis << " " << cuts;
        }
        ADD_FAILURE() << kind_name(whole) << " is divided for ever across " << axis;
      } catch (const std::invalid_argument& refused) {
        EXPECT_STREQ(refused.what(), "the shape is too thin to be divided in double precision");
        EXPECT_GT(cuts, 30) << kind_name(whole) << " " << axis;
      }
    }
  }
}

}  // namespace
}  // namespace shapeid
