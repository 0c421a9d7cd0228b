// Which applied transformations say the same as others.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::record;

using Names = std::vector<std::string>;

/// The arm without its last link, moved as the arm is.
Recording record_two_joints(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  const Recording whole = record({});
  std::vector<Sample> samples = whole.samples();
  for (Sample& s : samples) {
    for (Eigen::VectorXd* signal : {&s.q, &s.dq, &s.ddq, &s.tau}) signal->conservativeResize(2);
  }
  const Recording bare(samples, whole.rate());
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, 0.02);
  const std::vector<std::size_t> usable = bare.usable(1);
  for (const std::size_t i : usable) {
    const View view = viewer.view(bare, i);
    samples[i].tau = predict(viewer, view, {stacked_parameters(robot), effects}).force;
    for (double& tau : samples[i].tau) tau += noise(generator);
  }
  return {std::vector<Sample>(samples.begin() + static_cast<std::ptrdiff_t>(usable.front()),
                              samples.begin() + static_cast<std::ptrdiff_t>(usable.back()) + 1),
          whole.rate()};
}

/// Twice the gain at one of two joints is half of it at the other, and twice the masses.
TEST(Exchange, OfTwoJointsEitherMayHaveTheGain) {
  Robot robot = arm();
  robot.links.pop_back();
  LoopSettings settings = arm_settings();
  settings.shapes = generous_regions(robot, {1, 2});
  settings.size = Eigen::VectorXd::Ones(30);
  settings.size.tail(20) =
      reference::sizes_of_links(settings.shapes, Eigen::Vector2d::Constant(2.0));
  const Recording log = record_two_joints(robot, {effect("torque_gain", 1, {0.4})});
  const LoopResult result = close_loop(robot, log, nullptr, settings);
  ASSERT_EQ(result.found.size(), 1U);
  Names names = result.found[0].exchangeable;
  EXPECT_EQ(names.size(), 1U);
  names.push_back(result.found[0].id);
  for (const char* either : {"torque_gain@joint1", "torque_gain@joint2"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), either), 1) << either;
  }
  EXPECT_EQ(result.found[0].ambiguous_with, result.found[0].exchangeable);
}

/// Of three, one gain is two others.
TEST(Exchange, OfThreeJointsItsOwn) {
  const LoopResult result = test::loop_of(record({{effect("torque_gain", 1, {0.4})}}));
  ASSERT_EQ(test::found_ids(result), Names{"torque_gain@joint2"});
  EXPECT_EQ(result.found[0].exchangeable, Names{});
}

}  // namespace
}  // namespace shapeid::diagnosis
