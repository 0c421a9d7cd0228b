#include "shapeid/reference/filter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "shapeid/models/inertia.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using Eigen::Vector2d;

TEST(ParameterFilter, StartsAtTheFirstAndThenMixes) {
  ParameterFilter filter(0.25);
  EXPECT_FALSE(filter.value());
  EXPECT_EQ(filter.update(Vector2d(4.0, -8.0)), Vector2d(4.0, -8.0));
  EXPECT_EQ(filter.update(Vector2d(8.0, 8.0)), Vector2d(5.0, -4.0));  // 1/4 new, 3/4 old
  EXPECT_EQ(filter.update(Vector2d(1.0, 0.0)), Vector2d(4.0, -3.0));
}

TEST(ParameterFilter, OneDoesNotSmooth) {
  ParameterFilter filter(1.0);
  (void)filter.update(Vector2d(4.0, -8.0));
  EXPECT_EQ(filter.update(Vector2d(0.5, 3.0)), Vector2d(0.5, 3.0));
}

TEST(ParameterFilter, RefusesAlphaOutsideOfItsRange) {
  for (const double alpha : {0.0, -0.5, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(ParameterFilter{alpha}, std::invalid_argument) << alpha;
  }
}

// The cone of pseudo-inertias is convex: what is mixed from bodies is a body.
RC_GTEST_PROP(ParameterFilter, MixedBodiesAreBodies, ()) {
  ParameterFilter filter(*test::real(0.01, 1.0));
  for (int k = 0; k < 5; ++k) {
    const InertialParameters body = *test::body();
    RC_ASSERT(!why_impossible({filter.update(body.values)}));
  }
}

}  // namespace
}  // namespace shapeid::reference
