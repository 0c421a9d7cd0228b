// What a round of the loop looks at.
#include "shapeid/diagnosis/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

std::vector<AppliedEffect> hypotheses_beside(const std::vector<AppliedEffect>& effects) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  const RichModel model{stacked_parameters(robot), effects};
  return screened_hypotheses(
      robot, model, {log, series(robot, ContactTreatment::ignore, model, log, 1)}, std::nullopt);
}

/// Within how much speed friction turns round may be one number of the joint, whichever law it
/// follows: a law that is looked at with another width alone would be told by that from one whose
/// width was sought. It need not be one (two may act there), so the usual width is looked at, too.
TEST(Candidates, LawsOfAJointHaveAlsoTheWidthThatWasFoundThere) {
  AppliedEffect coulomb = test::effect("coulomb_friction", 1, {0.2});
  coulomb.shape[0] = 0.017;
  AppliedEffect stribeck = test::effect("stribeck_friction", 2, {0.3});
  stribeck.shape = Eigen::Vector2d(0.09, 0.11);
  const auto list = hypotheses_beside({coulomb, stribeck});
  const auto times = [&](const std::string& id, int site, double width) {
    return std::ranges::count_if(list, [&](const AppliedEffect& h) {
      return h.effect->id == id && h.site == site && h.shape[h.shape.size() - 1] == width;
    });
  };
  for (const std::string id : {"coulomb_friction", "load_friction", "stribeck_friction"}) {
    const double usual = find_effect(id)->shape.back().start;
    EXPECT_EQ(times(id, 0, usual), 1) << id;
    EXPECT_EQ(times(id, 1, 0.017), 1) << id;
    EXPECT_EQ(times(id, 1, usual), id == "coulomb_friction" ? 0 : 1) << id;
    EXPECT_EQ(times(id, 2, 0.11), 1) << id;
    EXPECT_EQ(times(id, 2, usual), id == "stribeck_friction" ? 0 : 1) << id;
  }
  // Nothing else is there twice; and a width alone is shared, not Stribeck's speed.
  EXPECT_EQ(list.size(), hypotheses_beside({}).size() + 4);
  for (const AppliedEffect& h : list) {
    if (h.effect->id != "stribeck_friction" || h.site == 2) continue;
    EXPECT_EQ(h.shape[0], find_effect("stribeck_friction")->shape[0].start);
  }
}

/// Of a ripple that a joint goes through less than twice, neighbouring periods look alike.
TEST(Candidates, ARippleIsLongIfTheJointGoesThroughLessThanTwoPeriods) {
  const Recording log = test::record({});
  const auto [least, most] = std::ranges::minmax_element(
      log.samples(), {}, [](const Sample& sample) { return sample.q[2]; });
  const double range = most->q[2] - least->q[2];
  ASSERT_GT(range, 0.5);
  constexpr double pi = 3.14159265358979323846;
  AppliedEffect ripple = test::effect("cogging", 2, {0.3, 0.1});
  const auto periods = [&](double count) {
    ripple.shape[0] = count * 2.0 * pi / range;
    return is_long_ripple(log, ripple);
  };
  EXPECT_TRUE(periods(0.7));
  EXPECT_TRUE(periods(1.99));
  EXPECT_FALSE(periods(2.01));
  EXPECT_FALSE(is_long_ripple(log, test::effect("coulomb_friction", 2, {0.2})));
}

/// The period of a ripple that went is that of the reference log, until it is found.
TEST(Candidates, ARippleThatWentIsSoughtWhereItWas) {
  const Robot robot = test::arm();
  AppliedEffect ripple = test::effect("cogging", 2, {0.3, 0.1});
  ripple.shape[0] = 17.0;
  const Recording log = test::record({}), earlier = test::record({{ripple}, 20.0, 0.02, 2});
  RichModel model{stacked_parameters(robot), {}};
  const auto period_of = [&](When when) {
    const auto rest = [&](const Recording& of) {
      return Rest{of, series(robot, ContactTreatment::ignore, model, of, 1)};
    };
    std::optional<double> period;
    for (const AppliedEffect& a : screened_hypotheses(robot, model, rest(log), rest(earlier))) {
      if (!is_ripple(a) || a.site != 2 || a.when != when) continue;
      EXPECT_FALSE(period) << "once";
      period = a.shape[0];
    }
    return period;
  };
  EXPECT_NEAR(period_of(When::gone).value(), 17.0, 0.1);
  EXPECT_TRUE(std::abs(period_of(When::always).value() - 17.0) > 0.5);
  ripple.when = When::gone;
  ripple.shape[0] = 17.3;
  model.effects = {ripple};
  EXPECT_EQ(period_of(When::gone), 17.3);
}

}  // namespace
}  // namespace shapeid::diagnosis
