// Needles, plates, grains of dust, shapes a kilometre away: the promises of shape.hpp hold there
// too.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "shapeid/models/shape.hpp"
#include "shapeid/tests/shapes/quadrature.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/shape_generators.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled;

/// Whole bodies with sides from a micrometre to a metre, independently: aspects up to a million.
rc::Gen<Shape> extreme() {
  const auto side = test::magnitude(1e-6, 1.0);
  const auto far = rc::gen::mapcat(test::magnitude(1e-3, 1e3), test::pose);
  return rc::gen::map(rc::gen::tuple(rc::gen::inRange(0, 4), rc::gen::tuple(side, side, side), far),
                      [](const auto& drawn) {
                        const auto& [kind, sides, pose] = drawn;
                        const Eigen::Vector3d size(std::get<0>(sides), std::get<1>(sides),
                                                   std::get<2>(sides));
                        if (kind == 0) return make_cuboid(size, pose);
                        if (kind == 1) return make_cylinder(size[0], size[1], pose);
                        if (kind == 2) return make_ellipsoid(size, pose);
                        std::vector<Eigen::Vector3d> corners;
                        for (const double x : {-0.5, 0.5}) {
                          for (const double y : {-0.5, 0.5}) {
                            for (const double z : {-0.5, 0.5}) {
                              corners.push_back(Eigen::Vector3d(x, y, z).cwiseProduct(size));
                            }
                          }
                        }
                        return make_convex_hull(corners, pose);
                      });
}

RC_GTEST_PROP(Extremes, MomentsAgreeWithQuadrature, ()) {
  test::check_against_quadrature(*extreme());
}

// Twelve halvings cut a needle crosswise into short pieces and leave a body every time.
RC_GTEST_PROP(Extremes, DivideWell, ()) {
  Shape part = *extreme();
  for (int i = 0; i < 12; ++i) {
    const auto [lower, upper] = divide(part);
    RC_ASSERT(!why_malformed(lower));
    RC_ASSERT(!why_malformed(upper));
    RC_ASSERT(!why_impossible(unit_parameters(upper)));
    // Bounds round at their own size, which at this depth may be 2^i widths.
    const double scale = volume(part) * std::ldexp(test::volume_rounding(part), i);
    RC_ASSERT(scaled(std::abs(volume(lower) - volume(upper)), scale, 2) < few_hundred_eps);
    RC_ASSERT(scaled(std::abs(volume(lower) + volume(upper) - volume(part)), scale, 2) <
              few_hundred_eps);
    part = upper;
  }
}

}  // namespace
}  // namespace shapeid
