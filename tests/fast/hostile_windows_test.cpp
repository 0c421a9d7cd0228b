// Samples that no robot sends: nothing is allocated, work stays bounded, and no answer is worse
// than none.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/window_runs.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid {
namespace {

using fast::Identifier;
using Fed = Identifier::Fed;

/// Every number of a sample that the identifier looks at.
std::vector<double*> numbers(Sample& s) {
  std::vector<double*> all = test::inputs(s);
  for (double& tau : s.tau) all.push_back(&tau);
  return all;
}

RC_GTEST_PROP(FastHostileWindows, AllocateNothingAndStayBounded, ()) {
  const Robot robot = test::bundled_quadruped();
  const BodyModel model = test::bundled_shapes(robot);
  std::vector<Sample> samples =
      test::trot(robot, stacked_parameters(robot), 7, 60, test::Noise::sensors);
  const bool warm = *rc::gen::arbitrary<bool>();
  const int divisions = *rc::gen::inRange(0, 8);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const double largest = std::numeric_limits<double>::max();
  const int spoilt = *rc::gen::inRange(1, 30);
  for (int k = 0; k < spoilt; ++k) {
    Sample& s = samples[*rc::gen::inRange<std::size_t>(0, samples.size())];
    const std::vector<double*> all = numbers(s);
    const double bad = *rc::gen::element(nan, infinite, -infinite, largest, -largest, 1e200, 1e100,
                                         1e30, -1e15, 1e-300, 5e-324, 0.0);
    const bool whole = *rc::gen::weightedElement<bool>({{1, true}, {4, false}});
    if (whole) {
      for (double* number : all) *number = bad;
    } else {
      *all[*rc::gen::inRange<std::size_t>(0, all.size())] = bad;
    }
  }

  fast::IdentifierSettings settings;
  settings.expected_mass = 6.0;
  settings.stride = *rc::gen::element<std::size_t>(1, 3, 10);
  settings.warm = warm;
  settings.division.most_divisions = divisions;
  Identifier identifier(robot, model, settings);
  bool sound = true;
  int iterations = 0;
  const std::size_t requests = test::allocations_during([&] {
    for (const Sample& s : samples) {
      const Fed fed = identifier.feed(s);
      if (fed != Fed::answered) continue;
      iterations = std::max(iterations, identifier.answer().iterations);
      sound = sound && identifier.Phi().allFinite() && identifier.filtered().allFinite() &&
              identifier.undivided_masses().minCoeff() >= 0.0;
    }
  });
  RC_ASSERT(requests == 0U);
  RC_ASSERT(iterations <= test::most_iterations(model, divisions));
  RC_ASSERT(sound);

  // What follows is answered again, once every bad sample has left the window.
  int answered = 0;
  for (const Sample& s :
       test::trot(robot, stacked_parameters(robot), 8, 60, test::Noise::sensors)) {
    answered += identifier.feed(s) == Fed::answered ? 1 : 0;
  }
  RC_ASSERT(answered >= 4);
  RC_ASSERT(identifier.Phi().allFinite());
}

// Lambda comes from the first answer and stays: a window whose torques are out of scale gives none,
// and what follows is as if the stream had begun there.
TEST(FastHostileWindows, AFirstOneOutOfScaleSpoilsNoOther) {
  const Robot robot = test::bundled_quadruped();
  const BodyModel model = test::bundled_shapes(robot);
  fast::IdentifierSettings settings;
  settings.expected_mass = 6.0;
  const std::vector<Sample> samples =
      test::trot(robot, stacked_parameters(robot), 7, 60, test::Noise::sensors);
  Identifier clean(robot, model, settings);
  for (const Sample& s : samples) clean.feed(s);
  for (const double factor : {1e5, 1e12, 1e100}) {
    Identifier identifier(robot, model, settings);
    for (std::size_t k = 0; k < settings.window; ++k) {
      Sample spoilt = samples[k];
      spoilt.tau *= factor;
      const Fed fed = identifier.feed(spoilt);
      ASSERT_EQ(fed, k + 1 < settings.window ? Fed::kept : Fed::window_declined) << factor;
    }
    EXPECT_EQ(identifier.outcome(), fast::Outcome::out_of_scale);
    EXPECT_FALSE(identifier.lambda());
    for (const Sample& s : samples) identifier.feed(s);
    EXPECT_EQ(identifier.lambda(), clean.lambda());
    EXPECT_EQ(identifier.Phi(), clean.Phi());
    EXPECT_EQ(identifier.filtered(), clean.filtered());
  }
}

}  // namespace
}  // namespace shapeid
