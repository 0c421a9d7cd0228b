// Several cuts before one solution: the shapes of the largest v, by (16), on masses that are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shapeid/fast/division.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using test::few_hundred_eps;
using test::scaled;

TEST(FastDivision, CutsTheShapesOfTheLargestCriterionAtOnce) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  // Boxes of different sizes around the origin: five independent columns.
  const std::vector<double> truth = {1.5, 0.2, 3.0, 0.7, 2.0};
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const auto x = static_cast<double>(j);
    const Eigen::Isometry3d pose(
        Eigen::Translation3d(0.1 * x, std::sin(x), 0.3 * std::cos(2.0 * x)));
    model.shapes.push_back(
        {0, make_cuboid({0.1 + 0.07 * x, 0.2, 0.4 - 0.05 * x}, pose), std::to_string(j)});
  }
  // Rows that measure all ten parameters of a body with these masses.
  Eigen::VectorXd Phi = Eigen::VectorXd::Zero(10);
  double V0 = 0.0;
  for (std::size_t j = 0; j < truth.size(); ++j) {
    Phi += truth[j] * unit_parameters(model.shapes[j].shape).values;
    V0 += volume(model.shapes[j].shape);
  }
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(11, 11);
  R.topLeftCorner(10, 10).setIdentity();
  R.topRightCorner(10, 1) = Phi;

  DivisionOptions options;
  options.expected_mass = 5.0;
  options.most_divisions = 4;
  Division division(model, options);
  division.set_lambda(0.0);
  ASSERT_EQ(division.start(R), Outcome::solved);
  std::vector<double> v;
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const double m = truth[j] / options.expected_mass;
    const double V = volume(model.shapes[j].shape) / V0;
    v.push_back(options.k1 * m * V + options.k2 * m / V);
  }
  std::vector<int> order(truth.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return v[static_cast<std::size_t>(i)] > v[static_cast<std::size_t>(j)];
  });

  ASSERT_EQ(division.divide(3), Division::Step::divided);
  ASSERT_EQ(division.history().size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    const Division::Cut& cut = division.history()[k];
    EXPECT_EQ(cut.place, order[k]);
    const double expected = v[static_cast<std::size_t>(order[k])];
    EXPECT_LT(scaled(std::abs(cut.criterion - expected), expected, 10), few_hundred_eps);
    const int second = static_cast<int>(truth.size() + k);
    EXPECT_EQ(division.id(cut.place), std::to_string(order[k]) + ".0");
    EXPECT_EQ(division.id(second), std::to_string(order[k]) + ".1");
  }
  // Parts of equal density already explain the rows: nothing moves.
  EXPECT_LT(scaled((division.masses().Phi() - Phi).norm(), Phi.norm(), 10), few_hundred_eps);
  // One more has room; of three that are asked for, one is cut.
  ASSERT_EQ(division.divide(3), Division::Step::divided);
  EXPECT_EQ(division.history().size(), 4U);
  EXPECT_EQ(division.divide(), Division::Step::no_room);
}

}  // namespace
}  // namespace shapeid::fast
