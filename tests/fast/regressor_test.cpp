// fast::Regressor against reference::regressor, which is held against Simbody.
#include "shapeid/fast/regressor.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/first_difference.hpp"
#include "shapeid/tests/fast/wanted.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid {
namespace {

using test::all_links;
using test::first_difference;
using test::inputs;
using test::nothing_moves;

using test::no_difference;

static_assert(std::is_nothrow_invocable_v<fast::Regressor, const Sample&>);

RC_GTEST_PROP(FastRegressor, FloatingRobotsAsTheReference, ()) {
  const Robot robot = *test::robot({1, 20, Root::floating});
  const Sample s = *test::sample(robot);
  fast::Regressor regressor(robot, all_links(robot));
  RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
}

RC_GTEST_PROP(FastRegressor, FixedRobotsAsTheReference, ()) {
  const Robot robot = *test::robot({1, 20, Root::fixed});
  const Sample s = *test::sample(robot);
  fast::Regressor regressor(robot, all_links(robot));
  RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
}

// Joints about coordinate axes take ways of their own.
RC_GTEST_PROP(FastRegressor, JointsAsInUrdfsAsTheReference, ()) {
  const Robot robot = test::any_robot(1, 20);
  const Sample s = *test::sample(robot);
  fast::Regressor regressor(robot, all_links(robot));
  RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
}

TEST(FastRegressor, CornerCasesAsTheReference) {
  for (const auto& [name, robot] : test::corner_robots()) {
    SCOPED_TRACE(name);
    fast::Regressor regressor(robot, all_links(robot));
    for (const Sample& s : test::corner_samples(robot)) {
      EXPECT_EQ(first_difference(regressor(s), robot, all_links(robot), s), no_difference);
    }
  }
}

// A fixed base on a slope, or on a vehicle that turns: the base's motion counts there as well.
RC_GTEST_PROP(FastRegressor, FixedRobotsOnMovingGround, ()) {
  const Robot robot = *test::robot({1, 10, Root::fixed});
  Robot floating = robot;
  floating.root = Root::floating;
  const Sample s = *test::sample(floating);
  fast::Regressor regressor(robot, all_links(robot));
  RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
}

RC_GTEST_PROP(FastRegressor, AnyLinksInAnyOrder, ()) {
  const Robot robot = *test::robot({1, 20, *rc::gen::element(Root::fixed, Root::floating)});
  const Sample s = *test::sample(robot);
  const std::vector<int> links = test::some_links(robot);
  fast::Regressor regressor(robot, links);
  RC_ASSERT(first_difference(regressor(s), robot, links, s) == no_difference);
}

// Nothing of an earlier sample stays.
RC_GTEST_PROP(FastRegressor, SamplesDoNotDisturbEachOther, ()) {
  const Robot robot = *test::robot({1, 10, *rc::gen::element(Root::fixed, Root::floating)});
  const std::vector<Sample> samples =
      *rc::gen::container<std::vector<Sample>>(4, test::sample(robot));
  const std::vector<int> links = test::some_links(robot);
  fast::Regressor regressor(robot, links);
  for (const Sample& s : samples)
    RC_ASSERT(first_difference(regressor(s), robot, links, s) == no_difference);
  regressor(samples.front());
  const Sample still = nothing_moves(robot);
  RC_ASSERT(regressor(still).isZero(0.0));
}

// A block has the samples' rows one below the other, whatever stood there before.
RC_GTEST_PROP(FastRegressor, BlocksStackTheirSamples, ()) {
  const Robot robot = *test::robot({1, 10, *rc::gen::element(Root::fixed, Root::floating)});
  const auto samples = *rc::gen::container<std::vector<Sample>>(
      *rc::gen::element<std::size_t>(0, 1, 2, 7), test::sample(robot));
  const std::vector<int> links = test::some_links(robot);
  fast::Regressor regressor(robot, links), alone(robot, links);
  const Eigen::Index dof = robot.dof();
  Eigen::MatrixXd Y = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(samples.size()) * dof,
                                                10 * static_cast<Eigen::Index>(links.size()), 7.0);
  regressor.of_block(samples, Y);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    RC_ASSERT(Y.middleRows(static_cast<Eigen::Index>(k) * dof, dof) == alone(samples[k]));
  }
}

// Each input alone: what only one term reads is not drowned by the others.
RC_GTEST_PROP(FastRegressor, EachInputAlone, ()) {
  const Robot robot = *test::robot({1, 8, *rc::gen::element(Root::fixed, Root::floating)});
  fast::Regressor regressor(robot, all_links(robot));
  Sample s = nothing_moves(robot);
  for (double* input : inputs(s)) {
    *input = 1.0;
    RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
    *input = 0.0;
  }
}

// Each pair of inputs: the products that centrifugal and Coriolis terms are made of, one by one.
RC_GTEST_PROP(FastRegressor, EachPairOfInputs, ()) {
  const Robot robot = *test::robot({2, 4, *rc::gen::element(Root::fixed, Root::floating)});
  fast::Regressor regressor(robot, all_links(robot));
  Sample s = nothing_moves(robot);
  const std::vector<double*> all = inputs(s);
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      *all[i] = 1.0;
      *all[j] = -0.7;
      RC_ASSERT(first_difference(regressor(s), robot, all_links(robot), s) == no_difference);
      *all[i] = *all[j] = 0.0;
    }
  }
}

#ifndef NDEBUG
TEST(FastRegressorDeathTest, SampleOfAnotherRobotEndsTheProgram) {
  Robot robot;
  robot.links.resize(2);
  robot.links[1].parent = 0;
  fast::Regressor regressor(robot, {1});
  EXPECT_DEATH(regressor(Sample()), "does not have an entry for each of 1 joints");
}

TEST(FastRegressor, LinksThatAreNotThereAreADefect) {
  Robot robot;
  robot.links.resize(1);
  EXPECT_THROW(fast::Regressor(robot, {0, 1}), Defect);
}
#endif

}  // namespace
}  // namespace shapeid
