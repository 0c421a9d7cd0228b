// Blocks that contradict each other are not said to lack motion.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/reference/identify.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::reference {
namespace {

/// A cube on one link, and a block of rows for each mass that is asked for; noise of `noise` kg.
std::string refused(const std::vector<double>& masses, double noise) {
  BodyModel model;
  model.known = Eigen::VectorXd::Zero(10);
  model.free_links = {0};
  model.shapes = {{0, make_cuboid({1.0, 1.0, 1.0}, Eigen::Isometry3d::Identity()), "0"}};
  const Eigen::VectorXd unit = shape_columns(model).col(0);
  test::Draw draw(5);
  CompressedRows rows;
  for (const double mass : masses) {
    Eigen::MatrixXd block(30, 11);
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      for (Eigen::Index j = 0; j < 10; ++j) block(i, j) = draw.normal();
      block(i, 10) = mass * block.row(i).head(10).dot(unit) + noise * draw.normal();
    }
    rows.blocks.push_back({triangle(block)});
    rows.samples += 30;
  }
  IdentifySettings settings;
  settings.expected_mass = 2.0;
  try {
    static_cast<void>(identify(model, rows, settings));
  } catch (const Refusal& refusal) {
    return refusal.code() + ": " + refusal.reason();
  }
  return "taken";
}

TEST(Disagreement, OneBlockOfMany) {
  EXPECT_EQ(refused({2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0}, 0.01), "taken");
  const std::string said = refused({2.0, 2.0, 2.0, 2.0, 40.0, 2.0, 2.0}, 0.01);
  EXPECT_EQ(said.substr(0, 52), "disagree: number 5 of 7 blocks of time, or logs, con") << said;
}

TEST(Disagreement, TheHalfOfThem) {
  std::vector<double> masses(12, 2.0);
  masses.resize(24, 20.0);
  const std::string said = refused(masses, 0.01);
  EXPECT_EQ(said.substr(0, 36), "disagree: the first half of the bloc") << said;
}

/// Noise that hides everything is no contradiction.
TEST(Disagreement, NoiseIsNone) {
  for (const std::size_t blocks : {7U, 24U}) {
    const std::string said = refused(std::vector<double>(blocks, 2.0), 100.0);
    EXPECT_EQ(said.substr(0, 12), "not-excited:") << said;
  }
}

}  // namespace
}  // namespace shapeid::reference
