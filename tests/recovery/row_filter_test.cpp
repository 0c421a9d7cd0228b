// Filtered rows obey the equations of motion as exactly as the rows themselves: across changes of
// contact, gaps, and the ends of segments.
#include "shapeid/reference/row_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapeid/reference/identify.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/recovery/quadruped.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using reference::FilteredRows;
using reference::RowFilter;
using test::bundled_quadruped;
using test::few_hundred_eps;
using test::Quadruped;
using test::scaled;
using test::scaled_difference;

constexpr auto project = ContactTreatment::project;

/// Base rows count less than joint rows, and no two alike.
Eigen::VectorXd uneven_weight(const Robot& robot) {
  return Eigen::VectorXd::LinSpaced(robot.dof(), 0.3, 4.0);
}

std::vector<FilteredRows> all_of(RowFilter& filter, const std::vector<Sample>& samples) {
  std::vector<FilteredRows> rows;
  for (const Sample& sample : samples) {
    filter.push(sample);
    while (auto row = filter.next()) rows.push_back(std::move(*row));
  }
  filter.finish();
  while (auto row = filter.next()) rows.push_back(std::move(*row));
  return rows;
}

/// Two steps and more on either side of a gap, with twenty lonely samples in its middle.
struct Pieces {
  std::vector<Sample> before, lonely, after;
  double terms = 0.0;  ///< the largest of all samples
};

Pieces trot_with_gap(const Robot& robot) {
  Pieces pieces;
  for (const SimulatedSample& s : test::trot(robot, {1.7, 500.0, 1, {}})) {
    const double t = s.sample.time;
    if (t < 1.1) pieces.before.push_back(s.sample);
    if (t > 1.15 && t < 1.19) pieces.lonely.push_back(s.sample);
    if (t > 1.25) pieces.after.push_back(s.sample);
    pieces.terms = std::max(pieces.terms, test::size_of_terms(reference::regressor(robot, s.sample),
                                                              stacked_parameters(robot)) +
                                              s.sample.tau.norm());
  }
  return pieces;
}

TEST(RowFilter, KeepsTheEquationsExactAcrossContacts) {
  const Quadruped quadruped = bundled_quadruped();
  const Pieces pieces = trot_with_gap(quadruped.robot);
  const Eigen::VectorXd weight = uneven_weight(quadruped.robot);
  const Eigen::VectorXd truth = stacked_parameters(quadruped.robot).head<10>();
  for (const std::vector<Sample>& samples : {pieces.before, pieces.after}) {
    EXPECT_TRUE(std::any_of(samples.begin(), samples.end(), [&](const Sample& s) {
      return s.in_contact != samples.front().in_contact;
    }));
    RowFilter filter(quadruped.robot, quadruped.base, project, weight, {});
    const auto rows = all_of(filter, samples);
    ASSERT_EQ(rows.size(), samples.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      ASSERT_EQ(rows[i].time, samples[i].time);
      ASSERT_LT(scaled((rows[i].Y * truth - rows[i].F).norm(),
                       std::sqrt(weight.maxCoeff()) * pieces.terms, quadruped.robot.dof()),
                few_hundred_eps)
          << "at " << rows[i].time;
    }
  }
}

// A gap separates two logs; what is too short to filter is left out.
TEST(RowFilter, BeginsAnewAfterAGap) {
  const Quadruped quadruped = bundled_quadruped();
  const Pieces pieces = trot_with_gap(quadruped.robot);
  const Eigen::VectorXd weight = uneven_weight(quadruped.robot);
  std::vector<Sample> joined;
  for (const auto& piece : {pieces.before, pieces.lonely, pieces.after}) {
    joined.insert(joined.end(), piece.begin(), piece.end());
  }
  RowFilter one(quadruped.robot, quadruped.base, project, weight, {});
  const auto found = all_of(one, joined);
  std::vector<FilteredRows> expected;
  for (const auto& piece : {pieces.before, pieces.after}) {
    RowFilter filter(quadruped.robot, quadruped.base, project, weight, {});
    for (FilteredRows& rows : all_of(filter, piece)) expected.push_back(std::move(rows));
  }
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].time, expected[i].time);
    ASSERT_EQ(found[i].Y, expected[i].Y);
    ASSERT_EQ(found[i].F, expected[i].F);
  }
}

// What does not change in time passes as it is: the rows of a Window, in other words. With one free
// link and with two.
TEST(RowFilter, LeavesStandstillAlone) {
  const Quadruped quadruped = bundled_quadruped();
  const Eigen::VectorXd weight = uneven_weight(quadruped.robot);
  BodyModel two = quadruped.base;
  two.free_links = {0, 3};
  two.known.segment<10>(30).setZero();
  two.shapes.push_back({3, make_point({0.1, 0.0, -0.05}, 1e-3), "knee"});
  for (const BodyModel& model : {quadruped.base, two}) {
    Sample sample = test::trot(quadruped.robot, {0.6, 500.0, 1, {}}).back().sample;
    reference::Window window(quadruped.robot, model, project, weight);
    window.add(sample);
    const Eigen::MatrixXd YtY = window.Y().transpose() * window.Y();
    const Eigen::VectorXd YtF = window.Y().transpose() * window.F();

    std::vector<Sample> samples;
    for (int i = 0; i < 300; ++i) {
      sample.time = 0.002 * i;
      samples.push_back(sample);
    }
    RowFilter filter(quadruped.robot, model, project, weight, {20.0, 2, 500.0, 7});
    const auto rows = all_of(filter, samples);
    EXPECT_EQ(rows.size(), 43u);  // 300 / 7, the first one included
    for (const FilteredRows& row : rows) {
      ASSERT_LT(scaled_difference(row.Y.transpose() * row.Y, YtY, 18), few_hundred_eps);
      ASSERT_LT(scaled_difference(row.Y.transpose() * row.F, YtF, 18), few_hundred_eps);
    }
  }
}

// What alternates from sample to sample is taken out: a Butterworth has a zero there.
TEST(RowFilter, TakesOutWhatAlternates) {
  const Quadruped quadruped = bundled_quadruped();
  const Sample still = test::trot(quadruped.robot, {0.6, 500.0, 1, {}}).back().sample;
  const Eigen::VectorXd weight = uneven_weight(quadruped.robot);
  std::vector<Sample> steady, alternating;
  for (int i = 0; i < 400; ++i) {
    steady.push_back(still);
    steady.back().time = 0.002 * i;
    alternating.push_back(steady.back());
    alternating.back().tau.array() += i % 2 == 0 ? 1.0 : -1.0;
  }
  RowFilter first(quadruped.robot, quadruped.base, project, weight, {});
  RowFilter second(quadruped.robot, quadruped.base, project, weight, {});
  const auto expected = all_of(first, steady), found = all_of(second, alternating);
  // Away from the ends, where the reflection has its pivot in one of the two.
  for (std::size_t i = 100; i < 300; ++i) {
    ASSERT_LT((found[i].F - expected[i].F).norm(), 1e-3 * expected[i].F.norm());
  }
}

// The slower filter that `identify` asks beside the rows: both are what each would be alone.
TEST(RowFilter, BesideTheRowsIsTheSameAsAlone) {
  const Quadruped quadruped = bundled_quadruped();
  const std::vector<Sample> samples = trot_with_gap(quadruped.robot).before;
  reference::IdentifySettings settings;
  settings.contacts = project;
  settings.weight = uneven_weight(quadruped.robot);
  settings.block_seconds = 0.25;
  const auto compressed = [&] {
    std::size_t next = 0;
    return compress(
        quadruped.robot, quadruped.base,
        [&]() -> std::optional<Sample> {
          return next < samples.size() ? std::optional(samples[next++]) : std::nullopt;
        },
        settings);
  };
  const auto rows_of = [](const std::vector<reference::RowBlock>& blocks) {
    std::vector<Eigen::MatrixXd> rows;
    for (const reference::RowBlock& block : blocks) rows.push_back(block.rows);
    return rows;
  };
  const auto plain = rows_of(compressed().blocks);
  settings.slower.emplace();
  settings.slower->cutoff = 7.0;
  settings.slower->keep_every = 3;
  const reference::CompressedRows both = compressed();
  settings.row_filter = settings.slower;
  settings.slower.reset();
  const auto alone = rows_of(compressed().blocks);
  EXPECT_GT(plain.size(), 2U);
  EXPECT_EQ(rows_of(both.blocks), plain);
  EXPECT_EQ(rows_of(both.slower), alone);
  EXPECT_NE(alone, plain);
}

}  // namespace
}  // namespace shapeid
