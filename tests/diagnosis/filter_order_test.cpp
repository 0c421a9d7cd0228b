// When filters of the load stop being of first order, and what is said of them then.
#include "shapeid/diagnosis/filter_order.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using Names = std::vector<std::string>;

Found found(const std::string& id, int site, std::vector<double> value, Names others = {}) {
  const AppliedEffect a = test::effect(id, site, std::move(value));
  Found f{a, hypothesis_id(test::arm(), a), Eigen::VectorXd::Zero(a.value.size())};
  f.ambiguous_with = std::move(others);
  return f;
}

/// Gains of other drives stay, and so does all else.
TEST(FilterOrder, TakesOutGainsOfTheSameDrive) {
  const Robot robot = test::arm();
  const LoopSettings settings = test::arm_settings();
  const Recording log = test::record({});
  LoopState state(robot, log, nullptr, settings);
  state.result.found = {found("torque_gain", 0, {0.2}), found("torque_lag", 1, {0.01}),
                        found("torque_gain", 1, {-0.02}), found("encoder_offset", 1, {0.02})};
  state.collect_effects();
  EXPECT_TRUE(state.result.found[1].effect.to_first_order);
  EXPECT_TRUE(state.result.model.effects[1].to_first_order);
  EXPECT_FALSE(state.result.model.effects[0].to_first_order);

  take_filters_as_they_are(state);
  EXPECT_EQ(test::found_ids(state.result),
            (Names{"torque_gain@joint1", "torque_lag@joint2", "encoder_offset@joint2"}));
  ASSERT_EQ(state.result.model.effects.size(), 3U);
  for (const AppliedEffect& a : state.result.model.effects) EXPECT_FALSE(a.to_first_order);

  // Others go on with the result, of another log or behind another filter.
  LoopState later(robot, log, nullptr, settings);
  later.result = state.result;
  later.collect_effects();
  for (const AppliedEffect& a : later.result.model.effects) EXPECT_FALSE(a.to_first_order);
}

/// Names of what was found beside it in the end are no longer in its place.
TEST(FilterOrder, KeepsNamesToFirstOrder) {
  const std::vector<Found> before =
      filters_among({found("torque_gain", 1, {0.1}, {"payload@link2"}),
                     found("torque_lag", 1, {0.01}, {"drag@link2", "torque_delay@all"})});
  ASSERT_EQ(before.size(), 1U);
  std::vector<Found> now = {found("torque_lag", 1, {0.012}, {"viscous_friction@joint2"}),
                            found("torque_lag", 2, {0.004}), found("torque_delay", 0, {0.001})};
  add_names_to_first_order(before, now);
  EXPECT_EQ(now[0].ambiguous_with, (Names{"viscous_friction@joint2", "drag@link2"}));
  EXPECT_EQ(now[1].ambiguous_with, Names{});
  EXPECT_EQ(now[2].ambiguous_with, Names{});
}

}  // namespace
}  // namespace shapeid::diagnosis
