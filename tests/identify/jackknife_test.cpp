// Standard errors against the closed form, where there is one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;
using test::scaled;

// Every block weighs the one shape once. The mass is then the mean of the readings, and its
// standard error that of a mean: the root of sum (b - mean)^2 / (n (n - 1)).
TEST(Jackknife, OfAMeanIsItsStandardError) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  model.shapes.push_back({0, make_cuboid({0.1, 0.2, 0.3}, Eigen::Isometry3d::Identity()), "0"});
  for (const std::vector<double>& readings :
       {std::vector{2.0, 2.1}, std::vector{1.9, 2.4, 2.2, 1.6, 2.1}}) {
    CompressedRows rows;
    for (const double reading : readings) {
      Eigen::MatrixXd block = Eigen::MatrixXd::Zero(11, 11);
      block(0, 0) = 1.0;
      block(0, 10) = reading;
      rows.blocks.push_back({block});
    }
    IdentifySettings settings;
    settings.expected_mass = 2.0;
    settings.lambda = 0.0;
    settings.division.most_divisions = 0;
    const Identification found = identify(model, rows, settings);

    const auto n = static_cast<double>(readings.size());
    const double mean = std::accumulate(readings.begin(), readings.end(), 0.0) / n;
    double squares = 0.0;
    for (const double reading : readings) squares += (reading - mean) * (reading - mean);
    const double error = std::sqrt(squares / (n * (n - 1.0)));
    EXPECT_LT(scaled(std::abs(found.Phi[0] - mean), mean, 11), few_hundred_eps);
    EXPECT_LT(scaled(std::abs(found.standard_error[0] - error), mean, 11), few_hundred_eps);
    // The shape's other parameters are its mass times what a unit of mass has.
    const InertialParameters unit = unit_parameters(model.shapes[0].shape);
    EXPECT_LT(scaled((found.standard_error - error * unit.values.cwiseAbs()).norm(), mean, 11),
              few_hundred_eps);
  }
}

BodyModel of_cuboids(const std::vector<Eigen::Vector3d>& sides) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10 * std::ssize(sides));
  for (std::size_t l = 0; l < sides.size(); ++l) {
    const int link = static_cast<int>(l);
    model.free_links.push_back(link);
    model.shapes.push_back(
        {link, make_cuboid(sides[l], Eigen::Isometry3d::Identity()), std::to_string(l)});
  }
  return model;
}

// Without its first block the mass is held at zero: errors are distances from the estimate, as that
// of a mean that no bound holds would not show.
TEST(Jackknife, IsAroundTheAnswer) {
  const BodyModel model = of_cuboids({{0.1, 0.2, 0.3}});
  CompressedRows rows;
  for (const double reading : {0.9, -0.2, 0.0}) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(11, 11);
    block(0, 0) = 1.0;
    block(0, 10) = reading;
    rows.blocks.push_back({block});
  }
  IdentifySettings settings;
  settings.expected_mass = 2.0;
  settings.lambda = 0.0;
  settings.division.most_divisions = 0;
  const Identification found = identify(model, rows, settings);
  const double answer = 0.7 / 3.0;
  // Without each: 0 (held there, -0.1), 0.45, 0.35.
  const double squares = answer * answer + std::pow(0.45 - answer, 2) + std::pow(0.35 - answer, 2);
  EXPECT_LT(scaled(std::abs(found.standard_error[0] - std::sqrt(2.0 / 3.0 * squares)), 1.0, 11),
            few_hundred_eps);
}

// One cuboid has one ratio of Ixx to mass. Readings of the mass are ten times as certain, in it, as
// those of Ixx, and say what both are.
TEST(Jackknife, IsOfTheShapesWhereTheyHoldANumber) {
  const BodyModel model = of_cuboids({{0.1, 0.4, 0.3}});
  const double ratio = unit_parameters(model.shapes[0].shape).values[4];
  CompressedRows rows;
  for (const double error : {1.0, -1.0, -1.0, 1.0, 1.0, -1.0}) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(11, 11);
    block(0, 0) = 10.0;
    block(0, 10) = 10.0 * 3.0 + 0.2 * error;
    block(1, 4) = 1.0 / ratio;
    block(1, 10) = 3.2 + 0.2 * (rows.blocks.size() % 2 == 0 ? 1.0 : -1.0);
    rows.blocks.push_back({block});
  }
  IdentifySettings settings;
  settings.expected_mass = 3.0;
  settings.lambda = 0.0;
  settings.division.most_divisions = 0;
  const Identification found = identify(model, rows, settings);
  ASSERT_TRUE(found.data.determined[0] && found.data.determined[4]);
  ASSERT_TRUE(found.data.agrees(4, found.Phi[4]));
  EXPECT_FALSE(is_held(found.standard_error[0], found.data.standard_error[0]));
  EXPECT_TRUE(is_held(found.standard_error[4], found.data.standard_error[4]));
  EXPECT_FALSE(found.slower);

  // The same numbers, and what the slower filter makes of them.
  rows.slower = rows.blocks;
  for (RowBlock& block : rows.slower) block.rows(1, 10) += 2.0;
  const Identification asked = identify(model, rows, settings);
  EXPECT_EQ(asked.Phi, found.Phi);
  EXPECT_EQ(asked.standard_error, found.standard_error);
  ASSERT_TRUE(asked.slower);
  EXPECT_LT(scaled(std::abs(asked.slower->value[4] - found.data.value[4] - 2.0 * ratio), 1.0, 11),
            few_hundred_eps);
  EXPECT_TRUE(asked.data.determined[0]);
  EXPECT_FALSE(asked.data.determined[4]) << "2 of 3 kg, more than half";
}

// Variances of 0.49 and 0.51 of the data's.
TEST(Held, IsWhatFollowsLessThanHalfOfTheData) {
  EXPECT_TRUE(is_held(0.70, 1.0));
  EXPECT_FALSE(is_held(0.7142, 1.0));
  EXPECT_TRUE(is_held(0.0, 1e-9)) << "a mass at zero";
  EXPECT_TRUE(is_held(1.0, std::numeric_limits<double>::infinity())) << "the data say nothing";
}

// By hand: two cuboids of 6 and 12 litres share 9 kg as 3 and 6. Every second moment of a cuboid is
// m (b^2 + c^2) / 12; first moments and products, zero by symmetry, count as a tenth of the
// largest of their group, first moments as a tenth of the mass.
TEST(NaturalSizes, AreWhatALinksShareOfTheMassMakes) {
  const BodyModel model = of_cuboids({{0.1, 0.2, 0.3}, {0.4, 0.1, 0.3}});
  const Eigen::VectorXd sizes = natural_sizes(model, 9.0);
  Eigen::VectorXd expected(20);
  expected << 3.0, 0.3, 0.3, 0.3, 0.0325, 0.00325, 0.00325, 0.025, 0.00325, 0.0125,  //
      6.0, 0.6, 0.6, 0.6, 0.05, 0.0125, 0.0125, 0.125, 0.0125, 0.085;
  EXPECT_LT(scaled((sizes - expected).norm(), expected.norm(), 20), few_hundred_eps) << sizes;
}

TEST(Identify, OneBlockThatTellsAllIsTooShort) {
  const BodyModel model = of_cuboids({{0.1, 0.2, 0.3}});
  CompressedRows rows;
  for (const double weight : {1.0, 0.0}) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(11, 11);
    block(0, 0) = weight;
    block(0, 10) = 2.0 * weight;
    rows.blocks.push_back({block});
  }
  IdentifySettings settings;
  settings.expected_mass = 2.0;
  try {
    static_cast<void>(identify(model, rows, settings));
    FAIL() << "accepted";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), "too-short");
  }
}

}  // namespace
}  // namespace shapeid::reference
