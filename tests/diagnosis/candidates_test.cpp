// What a round of the loop looks at.
#include "shapeid/diagnosis/candidates.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

/// Within how much speed friction turns round is the joint's, whichever law it follows: a law that
/// is looked at with another width would be told by that from one whose width was sought.
TEST(Candidates, LawsOfAJointHaveTheWidthThatWasFoundThere) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  AppliedEffect coulomb = test::effect("coulomb_friction", 1, {0.2});
  coulomb.shape[0] = 0.017;
  AppliedEffect stribeck = test::effect("stribeck_friction", 2, {0.3});
  stribeck.shape = Eigen::Vector2d(0.09, 0.11);
  const RichModel model{stacked_parameters(robot), {coulomb, stribeck}};
  const Series left = series(robot, ContactTreatment::ignore, model, log, 1);
  int looked_at = 0;
  for (const AppliedEffect& h : screened_hypotheses(robot, model, log, left)) {
    if (same_place(h, stribeck)) {
      EXPECT_EQ(h.shape, stribeck.shape);
      continue;
    }
    for (std::size_t i = 0; i < h.effect->shape.size(); ++i) {
      const ShapeNumber& number = h.effect->shape[i];
      if (number.name == "N") continue;  // where the residual has most of a ripple
      const double width = h.site == 1 ? 0.017 : h.site == 2 ? 0.11 : number.start;
      EXPECT_EQ(h.shape[static_cast<Eigen::Index>(i)],
                number.name == "width" ? width : number.start)
          << h.effect->id << " at " << h.site;
      ++looked_at;
    }
  }
  EXPECT_EQ(looked_at, 10) << "three laws with a width, one of them with another number, less one";
}

}  // namespace
}  // namespace shapeid::diagnosis
