// Irregular stamps, missing values, gaps, contacts: what is interpolated, and what is not.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/resampler.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::few_hundred_eps;
using test::log_columns;
using test::log_row;
using test::read_motion;
using test::regular_times;
using test::scaled;
using test::ScratchFolder;
using test::smooth_motion;
using test::write_log;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

std::vector<GridRow> resample(const std::vector<MeasuredRow>& rows, double rate, double longest) {
  Resampler grid(rate, Eigen::VectorXd::Constant(rows.front().values.size(), longest));
  std::vector<GridRow> out;
  const auto collect = [&] {
    while (std::optional<GridRow> row = grid.next()) out.push_back(std::move(*row));
  };
  for (const MeasuredRow& row : rows) {
    grid.push(row);
    collect();
  }
  grid.finish();
  collect();
  return out;
}

MeasuredRow row_at(double time, std::initializer_list<double> values) {
  MeasuredRow row;
  row.time = time;
  row.values = Eigen::VectorXd(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), row.values.begin());
  return row;
}

// Cubics pass through four points exactly; beside an end there are three, and the error is that of
// a parabola.
RC_GTEST_PROP(Resampler, CubicsComeOutExactly, ()) {
  const Eigen::VectorXd c = *test::vector(4, 2.0);
  const auto cubic = [&](double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); };
  std::vector<MeasuredRow> rows;
  double t = 0.0;
  for (int k = 0; k < 200; ++k) {
    rows.push_back(row_at(t, {cubic(t)}));
    t += *test::real(0.005, 0.015);
  }
  const auto grid = resample(rows, 100.0, 0.05);
  RC_ASSERT(grid.size() > 90u);
  for (const GridRow& row : grid) {
    if (row.time < rows[1].time || row.time > rows[198].time) continue;
    // Lagrange weights of such stamps stay below ten.
    RC_ASSERT(scaled(std::abs(row.values[0] - cubic(row.time)), 10.0 * (1.0 + c.norm() * 8.0), 4) <
              few_hundred_eps);
  }
}

// Every channel is taken at its own measurements: a slow one does not become a staircase.
TEST(Resampler, ChannelsKeepTheirOwnTimes) {
  std::vector<MeasuredRow> rows;
  for (int k = 0; k < 100; ++k) {
    const double t = 0.01 * k;
    rows.push_back(row_at(t, {2.0 * t, k % 4 == 0 ? 5.0 * t : no_value}));
  }
  for (const GridRow& row : resample(rows, 100.0, 0.1)) {
    EXPECT_LT(scaled(std::abs(row.values[0] - 2.0 * row.time), 2.0, 4), few_hundred_eps);
    EXPECT_LT(scaled(std::abs(row.values[1] - 5.0 * row.time), 5.0, 4), few_hundred_eps);
  }
}

TEST(Resampler, NothingIsInterpolatedAcrossAGapOfAnyChannel) {
  std::vector<MeasuredRow> rows;
  for (int k = 0; k < 300; ++k) {
    if (k > 50 && k < 70) continue;  // rows lost
    const bool second_lost = k > 150 && k < 180;
    rows.push_back(row_at(0.01 * k, {1.0 * k, second_lost ? no_value : 3.0 * k}));
  }
  const auto grid = resample(rows, 100.0, 0.05);
  int segments = 0;
  for (const GridRow& row : grid) {
    const double k = 100.0 * row.time;
    EXPECT_FALSE(k > 50.5 && k < 69.5) << row.time;
    EXPECT_FALSE(k > 150.5 && k < 179.5) << row.time;
    EXPECT_LT(std::abs(row.values[1] - 3.0 * k), 1e-9);
    segments += row.starts_segment ? 1 : 0;
  }
  EXPECT_EQ(segments, 3);
  // One row may be lost at each edge, where the grid lands a rounding error outside.
  EXPECT_GE(grid.size(), 300u - 19u - 29u - 3u);
}

TEST(Resampler, AChannelThatDiesDoesNotFillTheMemory) {
  Resampler grid(100.0, Eigen::VectorXd::Constant(2, 0.05));
  std::size_t out = 0;
  for (int k = 0; k < 100000; ++k) {
    grid.push(row_at(0.01 * k, {1.0, k < 1000 ? 2.0 : no_value}));
    while (grid.next()) ++out;
  }
  grid.finish();
  EXPECT_FALSE(grid.next());
  EXPECT_NEAR(static_cast<double>(out), 1000.0, 2.0);
  EXPECT_LT(grid.held(), 20u);
}

TEST(Motion, IrregularStampsGiveTheSameMotion) {
  const Robot robot = chain(3, Root::floating);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(0.0005, 0.0035);
  std::vector<double> times = {0.0};
  while (times.size() < 8000) times.push_back(times.back() + step(random));
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  write_log(path, robot, times, [&](double t) { return smooth_motion(robot, t); });
  const auto [samples, report] = read_motion(path, robot);
  EXPECT_EQ(report.gaps, 0u);
  ASSERT_GT(samples.size(), 5000u);
  const auto regular = scratch.path("b.csv");
  write_log(regular, robot, regular_times(0.0, report.rate, 8000),
            [&](double t) { return smooth_motion(robot, t); });
  // The same filter over the same motion: what differs is the interpolation alone. Cubics through
  // 3.5 ms steps miss a 1.7 Hz sine by (2 pi 1.7 h)^4 / 40, and a second difference of a 20 Hz
  // band amplifies what is missed by (2 pi 20)^2.
  const auto exact = read_motion(regular, robot).samples;
  const double amplitude = 0.6, h = 0.0035, w = 2.0 * std::numbers::pi * 1.7;
  const double missed = amplitude * std::pow(w * h, 4) / 40.0;
  const double band = std::pow(2.0 * std::numbers::pi * 20.0, 2);
  for (std::size_t k = 100; k < std::min(samples.size(), exact.size()) - 100; ++k) {
    ASSERT_LT(std::abs(samples[k].time - exact[k].time), 1e-9);
    EXPECT_LT((samples[k].q - exact[k].q).lpNorm<Eigen::Infinity>(), missed);
    EXPECT_LT((samples[k].ddq - exact[k].ddq).lpNorm<Eigen::Infinity>(), missed * band);
  }
}

TEST(Motion, SegmentsLoseTheirEndsAndNothingCrossesAGap) {
  const Robot robot = chain(2, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  std::vector<double> times;
  for (const double t : regular_times(0.0, 500.0, 6000)) {
    if (!(t > 4.0 && t < 4.5) && !(t > 8.0 && t < 8.2)) times.push_back(t);
  }
  // The positions jump at the gap, as when a log is cut: a derivative across it would be huge.
  write_log(path, robot, times, [&](double t) {
    Sample s = smooth_motion(robot, t);
    if (t > 4.2) s.q.array() += 1.0;
    return s;
  });
  const auto [samples, report] = read_motion(path, robot);
  EXPECT_EQ(report.gaps, 2u);
  EXPECT_GT(report.dropped_at_ends, 6u * 20u);
  EXPECT_LT(report.dropped_at_ends, 6u * 60u);
  for (const Sample& s : samples) {
    EXPECT_FALSE(s.time > 3.95 && s.time < 4.55) << s.time;
    const Sample truth = smooth_motion(robot, s.time);
    EXPECT_LT((s.dq - truth.dq).lpNorm<Eigen::Infinity>(), 0.01);
    EXPECT_LT((s.ddq - truth.ddq).lpNorm<Eigen::Infinity>(), 0.1);
  }
}

TEST(Motion, SegmentsTooShortToFilterAreCountedAsLost) {
  const Robot robot = chain(1, Root::fixed);
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  std::vector<double> times;
  for (int k = 0; k < 5000; ++k) {
    if (k % 20 < 10) times.push_back(k / 500.0);
  }
  write_log(path, robot, times, [&](double t) { return smooth_motion(robot, t); });
  const auto [samples, report] = read_motion(path, robot);
  EXPECT_TRUE(samples.empty());
  EXPECT_EQ(report.gaps, 249u);
  EXPECT_GE(report.dropped_at_ends, 2250u);
}

/// A standing robot whose one foot touches during [1, 2) s, and whose flag is not known after 4 s.
class Contacts : public testing::Test {
 protected:
  Contacts() : robot_(chain(3, Root::floating)) {
    robot_.contacts.push_back({"l2", 3, ContactKind::point, Eigen::Isometry3d::Identity()});
  }

  static bool touches(double t) { return t >= 1.0 && t < 2.0; }

  std::string write_flags() {
    auto path = scratch_.path("a.csv");
    LogWriter writer(path, log_columns(robot_));
    for (const double t : regular_times(0.0, 500.0, 3000)) {
      Sample s = smooth_motion(robot_, t);
      s.in_contact = {touches(t)};
      std::vector<double> row = log_row(robot_, s);
      if (t > 4.0) row.back() = t < 5.0 ? -1.0 : no_value;
      writer.write(row);
    }
    writer.close();
    return path;
  }

  Robot robot_;
  ScratchFolder scratch_;
};

TEST_F(Contacts, DropLeavesOutWhatIsNearAChangeOrNotKnown) {
  MotionOptions options;
  options.at_contact_change = ContactChange::drop;
  options.contact_margin = 0.1;
  const auto [samples, report] = read_motion(write_flags(), robot_, options);
  EXPECT_TRUE(report.contacts_logged);
  constexpr double slack = 1e-9;  // stamps of the grid
  std::size_t touching = 0;
  for (const Sample& s : samples) {
    ASSERT_EQ(s.in_contact.size(), 1u);
    EXPECT_EQ(s.in_contact[0], touches(s.time));
    for (const double change : {1.0, 2.0, 4.0}) {
      EXPECT_GT(std::abs(s.time - change), 0.1 - 0.002 - slack);
    }
    EXPECT_LT(s.time, 4.0);
    touching += s.in_contact[0] ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(touching), 400.0, 3.0);
  EXPECT_NEAR(static_cast<double>(samples.size()), 2000.0 - 500.0 / 2.0 - 40.0, 12.0);
  // The grid may end a rounding error behind the last stamp.
  EXPECT_GE(report.dropped_at_contacts + report.samples + report.dropped_at_ends, 2999u);
  EXPECT_LE(report.dropped_at_contacts + report.samples + report.dropped_at_ends, 3000u);
}

TEST_F(Contacts, WidenLetsAFootTouchEarlierAndLonger) {
  MotionOptions options;
  options.contact_margin = 0.1;
  const auto [samples, report] = read_motion(write_flags(), robot_, options);
  // The stance lasts from 1 to 1.998 s; from 4.002 s on nothing is known, so a touch may come then.
  constexpr double half_step = 0.001;
  for (const Sample& s : samples) {
    const double t = s.time;
    EXPECT_LT(t, 4.0 + half_step);
    if (std::abs(t - 0.9) < half_step || std::abs(t - 2.098) < half_step) continue;  // on the edge
    if (std::abs(t - 3.902) < half_step) continue;
    EXPECT_EQ(s.in_contact[0], (t > 0.9 && t < 2.098) || t > 3.902) << t;
  }
  EXPECT_GT(report.samples, 1950u);
}

TEST_F(Contacts, NoMarginKeepsAllThatIsKnown) {
  MotionOptions options;
  options.contact_margin = 0.0;
  const auto [samples, report] = read_motion(write_flags(), robot_, options);
  std::size_t touching = 0;
  for (const Sample& s : samples) touching += s.in_contact[0] ? 1 : 0;
  EXPECT_EQ(touching, 500u);
}

/// Who does not ask for contacts needs no flags; who does is told.
TEST_F(Contacts, NeedNotBeLoggedIfNobodyNeedsThem) {
  const Robot bare = chain(3, Root::floating);
  const auto path = scratch_.path("c.csv");
  write_log(path, bare, regular_times(0.0, 500.0, 3000),
            [&](double t) { return smooth_motion(bare, t); });
  MotionOptions options;
  EXPECT_THROW(static_cast<void>(read_motion(path, robot_, options)), InputError);
  options.contacts_needed = false;
  const auto [samples, report] = read_motion(path, robot_, options);
  EXPECT_FALSE(report.contacts_derived);
  EXPECT_FALSE(report.contacts_logged);
  EXPECT_GT(samples.size(), 2900u);
  EXPECT_TRUE(samples.front().in_contact.empty());
}

TEST_F(Contacts, AreDerivedByTheCallersRuleWhenNotLogged) {
  const Robot bare = chain(3, Root::floating);
  const auto path = scratch_.path("b.csv");
  write_log(path, bare, regular_times(0.0, 500.0, 3000),
            [&](double t) { return smooth_motion(bare, t); });
  MotionOptions options;
  options.contact_margin = 0.0;
  options.derive_contacts = [](const Sample& s) -> std::optional<std::vector<bool>> {
    if (s.time > 4.0) return std::nullopt;
    return std::vector<bool>{s.q[0] > 0.0};
  };
  const auto [samples, report] = read_motion(path, robot_, options);
  EXPECT_TRUE(report.contacts_derived);
  EXPECT_FALSE(report.contacts_logged);
  EXPECT_GT(samples.size(), 1900u);
  for (const Sample& s : samples) {
    EXPECT_EQ(s.in_contact, std::vector<bool>{s.q[0] > 0.0});
    EXPECT_LE(s.time, 4.0);
  }
}

}  // namespace
}  // namespace shapeid
