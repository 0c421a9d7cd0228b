// Standard errors against the closed form, where there is one.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

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
       {std::vector{2.0, 2.3}, std::vector{1.9, 2.4, 2.2, 1.6, 2.1}}) {
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

}  // namespace
}  // namespace shapeid::reference
