// Equation (16): which shape is divided, worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "shapeid/reference/division.hpp"
#include "shapeid/tests/support/any_model.hpp"

namespace shapeid::reference {
namespace {

/// Three cuboids of volumes 1, 2 and 5 (V0 = 8) and a point that counts for none of the choice.
BodyModel three_cuboids() {
  BodyModel model = test::one_cuboid({0, 0, 0}, {1, 1, 1});
  const auto here = Eigen::Isometry3d::Identity();
  model.shapes.push_back({0, make_cuboid({2, 1, 1}, here), "1"});
  model.shapes.push_back({0, make_cuboid({1, 5, 1}, here), "2"});
  return model;
}

TEST(Criterion, ByHand) {
  const DivisionOptions options{.k1 = 2.0, .k2 = 0.5, .expected_mass = 4.0};
  const Eigen::VectorXd v =
      division_criterion(three_cuboids(), Eigen::Vector3d(1.0, 2.0, 4.0), options);
  // k1 (m/4)(V/8) + k2 (m/4)/(V/8)
  EXPECT_DOUBLE_EQ(v[0], 2.0 / 4 / 8 + 0.5 / 4 * 8);
  EXPECT_DOUBLE_EQ(v[1], 2.0 * 2 / 4 * 2 / 8 + 0.5 * 2 / 4 * 8 / 2);
  EXPECT_DOUBLE_EQ(v[2], 2.0 * 5 / 8 + 0.5 * 8 / 5);
}

TEST(Criterion, PointsAndEmptyShapesAreNotDivided) {
  BodyModel model = three_cuboids();
  model.shapes[1].shape = make_point({0, 0, 0}, 2.0);
  const Eigen::VectorXd v =
      division_criterion(model, Eigen::Vector3d(0.0, 9.0, 1.0), {.expected_mass = 1.0});
  EXPECT_EQ(v[0], 0.0);
  EXPECT_EQ(v[1], 0.0);
  EXPECT_GT(v[2], 0.0);
}

TEST(NextToDivide, LargestWinsAndTiesGoToTheSmallestPlace) {
  EXPECT_EQ(next_to_divide(Eigen::Vector3d(1.0, 3.0, 2.0), 1e-9), 1);
  EXPECT_EQ(next_to_divide(Eigen::Vector3d(1.0, 3.0, 3.0), 1e-9), 1);
  EXPECT_EQ(next_to_divide(Eigen::Vector3d(1.0, 3.0, 3.0 * (1.0 + 1e-12)), 1e-9), 1);
  EXPECT_EQ(next_to_divide(Eigen::Vector3d(1.0, 3.0, 3.0 * (1.0 + 1e-6)), 1e-9), 2);
  EXPECT_EQ(next_to_divide(Eigen::Vector3d(3.0, 3.0, 3.0), 0.0), 0);
}

TEST(NextToDivide, NothingToDivide) {
  EXPECT_EQ(next_to_divide(Eigen::VectorXd(), 1e-9), -1);
  EXPECT_EQ(next_to_divide(Eigen::Vector3d::Zero(), 1e-9), -1);
}

TEST(DivisionOptions, SenselessOnesAreRefused) {
  test::ModelWithRows given;
  given.model = three_cuboids();
  given.problem.Y = Eigen::MatrixXd::Ones(1, 10);
  given.problem.F = given.problem.W = Eigen::VectorXd::Ones(1);
  test::use_shapes(given.problem, given.model, 1.0);
  const auto run = [&](const DivisionOptions& options) {
    return divide_and_solve(given.model, given.problem, options);
  };
  EXPECT_NO_THROW(run({.most_divisions = 1, .expected_mass = 1.0}));
  EXPECT_THROW(run({.most_divisions = 1}), std::invalid_argument);  // no expected mass
  EXPECT_THROW(run({.k1 = -1.0, .expected_mass = 1.0}), std::invalid_argument);
  EXPECT_THROW(run({.k1 = 0.0, .k2 = 0.0, .expected_mass = 1.0}), std::invalid_argument);
  EXPECT_THROW(run({.step = -1.0, .expected_mass = 1.0}), std::invalid_argument);
  EXPECT_THROW(run({.patience = 0, .expected_mass = 1.0}), std::invalid_argument);
  EXPECT_THROW(run({.most_divisions = -1, .expected_mass = 1.0}), std::invalid_argument);
  EXPECT_THROW(run({.tie = 1.0, .expected_mass = 1.0}), std::invalid_argument);
}

// Equal densities tie, and the first shape is cut again and again: far beyond what a double can
// tell apart, if nothing ended it.
TEST(Criterion, NoShapeIsCutForEver) {
  test::ModelWithRows given;
  given.model = test::one_cuboid({0, 0, 0}, {1, 1, 1});
  given.problem.Y = Eigen::MatrixXd::Identity(1, 10);
  given.problem.F = given.problem.W = Eigen::VectorXd::Ones(1);
  test::use_shapes(given.problem, given.model, 1.0);
  constexpr int divisions = 3 * 53 + 5;  // rounding forbids the 53rd cut of a side
  const DivisionRun run = divide_and_solve(
      given.model, given.problem,
      {.k1 = 0.0, .k2 = 1.0, .step = 0.0, .most_divisions = divisions, .expected_mass = 1.0});
  ASSERT_EQ(run.history.size(), static_cast<std::size_t>(divisions));
  int most = 0;
  for (const SoughtShape& shape : run.model.shapes) {
    most = std::max(most, static_cast<int>(std::count(shape.id.begin(), shape.id.end(), '.')));
  }
  EXPECT_EQ(most, most_cuts);
}

}  // namespace
}  // namespace shapeid::reference
