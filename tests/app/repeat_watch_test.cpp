// Which samples say again what was said, to the row.
#include "shapeid/app/track_repeats.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

namespace shapeid::app {
namespace {

constexpr double lost_value = std::numeric_limits<double>::quiet_NaN();

/// A joint with a logged velocity: q, dq, tau.
ChannelPlan joint_plan() {
  ChannelPlan plan;
  plan.channels.resize(3);
  plan.q = 0;
  plan.dq = 1;
  plan.tau = 2;
  return plan;
}

void push(RepeatWatch& watch, double time, std::initializer_list<double> values) {
  MeasuredRow row;
  row.time = time;
  row.values =
      Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
  watch.push(row);
}

TEST(RepeatWatch, TheRowsOnBothSidesMustRepeat) {
  RepeatWatch watch(joint_plan(), 1);
  push(watch, 0.0, {1.0, 0.0, 5.0});
  push(watch, 1.0, {1.0, 0.0, 5.0});
  push(watch, 2.0, {1.0, 0.0, 5.0});
  push(watch, 3.0, {1.5, 0.0, 5.5});
  push(watch, 4.0, {1.5, 0.0, 5.5});
  push(watch, 5.0, {2.0, 0.0, 6.0});
  EXPECT_FALSE(watch.repeats(0.0));  // nothing was before it
  EXPECT_FALSE(watch.repeats(0.5));
  EXPECT_TRUE(watch.repeats(1.0));
  EXPECT_TRUE(watch.repeats(1.5));
  EXPECT_FALSE(watch.repeats(2.0));
  EXPECT_FALSE(watch.repeats(2.5));
  EXPECT_FALSE(watch.repeats(3.0));
  EXPECT_FALSE(watch.repeats(4.0));  // one row twice
  EXPECT_FALSE(watch.repeats(5.0));
}

TEST(RepeatWatch, AllPositionsAreEnoughAndSoAreAllTorques) {
  ChannelPlan two_joints;
  two_joints.channels.resize(4);
  two_joints.q = 0;
  two_joints.tau = 2;
  RepeatWatch watch(two_joints, 2);
  push(watch, 0.0, {1.0, 2.0, 5.0, 6.0});
  push(watch, 1.0, {1.0, 2.1, 5.0, 6.0});  // a position flickers
  push(watch, 2.0, {1.0, 2.1, 5.0, 6.1});  // a torque
  push(watch, 3.0, {1.0, 2.2, 5.0, 6.2});  // one of each
  push(watch, 4.0, {1.0, 2.2, 5.0, 6.2});
  EXPECT_TRUE(watch.repeats(1.0));
  EXPECT_FALSE(watch.repeats(2.0));
  EXPECT_FALSE(watch.repeats(3.0));
  EXPECT_TRUE(watch.repeats(4.0));
}

TEST(RepeatWatch, WhatNoSampleIsMadeOfMayChange) {
  RepeatWatch watch(joint_plan(), 1);
  push(watch, 0.0, {1.0, 0.1, 5.0});
  push(watch, 1.0, {1.0, 0.2, 5.0});
  push(watch, 2.0, {1.0, 0.3, lost_value});
  push(watch, 3.0, {lost_value, 0.4, 5.0});
  EXPECT_TRUE(watch.repeats(1.0));
  EXPECT_TRUE(watch.repeats(2.0));
  EXPECT_TRUE(watch.repeats(3.0));
}

TEST(RepeatWatch, NothingRepeatsWhatWasBeforeABreak) {
  RepeatWatch watch(joint_plan(), 1);
  for (const double time : {0.0, 1.0, 2.0}) push(watch, time, {1.0, 0.0, 5.0});
  watch.restart();
  EXPECT_TRUE(watch.repeats(2.0));  // samples from before are asked for behind it
  for (const double time : {10.0, 11.0}) push(watch, time, {1.0, 0.0, 5.0});
  EXPECT_FALSE(watch.repeats(10.0));
  EXPECT_TRUE(watch.repeats(11.0));
  watch.restart();  // the clock is set back
  for (const double time : {0.0, 1.0}) push(watch, time, {1.0, 0.0, 5.0});
  EXPECT_FALSE(watch.repeats(0.0));
  EXPECT_TRUE(watch.repeats(1.0));
}

}  // namespace
}  // namespace shapeid::app
