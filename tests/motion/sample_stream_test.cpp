// Rows pushed in one by one give the samples that a causal reader makes of the whole log.
#include "shapeid/models/sample_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shapeid/models/error.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/motion/scratch.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::few_hundred_eps;
using test::read_motion;
using test::scaled;
using test::Scratch;
using test::smooth_motion;
using test::write_log;

constexpr double cutoff = 12.0;

Robot walker(bool with_contact) {
  Robot robot = chain(3, Root::floating);
  if (with_contact) {
    robot.contacts.push_back({"l2", 3, ContactKind::point, Eigen::Isometry3d::Identity()});
  }
  return robot;
}

/// Uneven stamps of about 500 Hz, and a gap of a tenth of a second.
std::vector<double> uneven_times() {
  std::vector<double> times;
  for (int k = 0; k < 3000; ++k) {
    times.push_back(0.002 * k + 0.0004 * std::sin(1.7 * k) + (k < 1400 ? 0.0 : 0.1));
  }
  return times;
}

Sample stepping(const Robot& robot, double t) {
  Sample s = smooth_motion(robot, t);
  s.in_contact.assign(robot.contacts.size(), std::sin(5.0 * t) > 0.0);
  return s;
}

MotionOptions causal() {
  MotionOptions options;
  options.smoothing = Smoothing::causal;
  options.cutoff = cutoff;
  return options;
}

StreamOptions streamed() {
  StreamOptions options;
  options.cutoff = cutoff;
  return options;
}

void expect_same(const Sample& a, const Sample& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.dq, b.dq);
  EXPECT_EQ(a.ddq, b.ddq);
  EXPECT_EQ(a.tau, b.tau);
  EXPECT_EQ(a.base_angular_velocity, b.base_angular_velocity);
  EXPECT_EQ(a.base_angular_acceleration, b.base_angular_acceleration);
  EXPECT_EQ(a.base_specific_force, b.base_specific_force);
  EXPECT_EQ(a.in_contact, b.in_contact);
}

/// A log and the stream that it is pushed into.
struct Streaming {
  Scratch scratch;
  std::string path = scratch.path("x.csv");
  Robot robot;
  std::vector<MeasuredRow> rows;
  ChannelPlan plan;

  Streaming(bool with_contact, const std::vector<double>& times) : robot(walker(with_contact)) {
    write_log(path, robot, times, [&](double t) { return stepping(robot, t); });
    MeasuredRows log(path, robot, {});
    plan = log.plan();
    while (std::optional<MeasuredRow> row = log.next()) rows.push_back(std::move(*row));
  }

  [[nodiscard]] SampleStream stream(StreamOptions options) const {
    return {path, plan, robot, Eigen::Isometry3d::Identity(), std::move(options)};
  }
};

std::vector<Sample> drained(SampleStream& stream, const std::vector<MeasuredRow>& rows) {
  std::vector<Sample> samples;
  for (const MeasuredRow& row : rows) {
    stream.push(row);
    while (std::optional<Sample> sample = stream.next()) samples.push_back(std::move(*sample));
  }
  return samples;
}

TEST(SampleStream, EqualsTheCausalReader) {
  for (const bool with_contact : {false, true}) {
    const Streaming log(with_contact, uneven_times());
    SampleStream stream = log.stream(streamed());
    const std::vector<Sample> samples = drained(stream, log.rows);
    const test::ReadMotion whole = read_motion(log.path, log.robot, causal());
    EXPECT_EQ(stream.rate(), whole.report.rate);
    EXPECT_EQ(stream.segments(), whole.report.gaps + 1);
    EXPECT_EQ(stream.group_delay(), whole.report.group_delay);
    // The last ones wait for the margin around changes of contact, half a period of the cutoff, and
    // for the rows of a cubic and a difference.
    EXPECT_LE(samples.size(), whole.samples.size());
    EXPECT_GE(static_cast<double>(samples.size()) + 0.5 / cutoff * stream.rate() + 6.0,
              static_cast<double>(whole.samples.size()));
    ASSERT_FALSE(samples.empty());
    for (std::size_t k = 0; k < std::min(samples.size(), whole.samples.size()); ++k) {
      expect_same(samples[k], whole.samples[k]);
    }
  }
}

/// Touches by the first joint; cannot be told by the second one.
std::optional<std::vector<bool>> by_joints(const Sample& sample) {
  if (sample.q[1] > 0.35) return std::nullopt;
  return std::vector{sample.q[0] > 0.1};
}

TEST(SampleStream, DerivesContactsAsTheReaderDoes) {
  Streaming log(false, uneven_times());
  log.robot = walker(true);
  StreamOptions options = streamed();
  options.derive_contacts = by_joints;
  SampleStream stream = log.stream(options);
  const std::vector<Sample> samples = drained(stream, log.rows);
  MotionOptions reading = causal();
  reading.derive_contacts = by_joints;
  const std::vector<Sample> whole = read_motion(log.path, log.robot, reading).samples;
  ASSERT_GT(samples.size(), 500U);
  ASSERT_LE(samples.size(), whole.size());
  std::size_t touching = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    expect_same(samples[k], whole[k]);
    touching += samples[k].in_contact.at(0) ? 1 : 0;
  }
  EXPECT_GT(touching, 100U);
  EXPECT_LT(touching, samples.size() - 100U);
  EXPECT_THROW(static_cast<void>(log.stream(streamed())), InputError);
  StreamOptions without = streamed();
  without.contacts_needed = false;
  SampleStream bare = log.stream(without);
  EXPECT_TRUE(drained(bare, log.rows).at(0).in_contact.empty());
}

// Two poles: 1 / (2 rate tan(pi fc / rate) sin(pi / 4)), on a grid that was asked for.
TEST(SampleStream, StatesItsGroupDelay) {
  const Streaming log(false, test::regular_times(0.0, 500.0, 400));
  StreamOptions options = streamed();
  options.rate = 625.0;
  SampleStream stream = log.stream(options);
  static_cast<void>(drained(stream, log.rows));
  EXPECT_EQ(stream.rate(), 625.0);
  const double known = 1.0 / (2.0 * 625.0 * std::tan(std::numbers::pi * cutoff / 625.0) *
                              std::sin(std::numbers::pi / 4.0));
  EXPECT_LT(scaled(std::abs(stream.group_delay() - known), known, 2), few_hundred_eps);
}

// Nothing can be said before the rate is known; the rows until then are not lost.
TEST(SampleStream, LearnsItsRateFromTheFirstRows) {
  const Streaming log(false, test::regular_times(3.0, 500.0, 600));
  SampleStream stream = log.stream(streamed());
  for (std::size_t k = 0; k < log.rows.size(); ++k) {
    EXPECT_EQ(stream.rate() > 0.0, k >= SampleStream::head_rows) << k;
    stream.push(log.rows[k]);
  }
  SampleStream twice = log.stream(streamed());
  // A clock that runs back among the first rows: the rate is that of the rows after it.
  for (const std::size_t k : {0U, 50U, 100U}) twice.push(log.rows[k]);
  const std::vector<Sample> samples = drained(twice, log.rows);
  EXPECT_EQ(twice.rate(), stream.rate());
  ASSERT_FALSE(samples.empty());
  expect_same(samples.front(), *stream.next());
}

// Filters forget what came before.
TEST(SampleStream, StartsAnewWhereItIsTold) {
  const Streaming log(true, test::regular_times(0.0, 500.0, 2000));
  const std::vector<MeasuredRow> first(log.rows.begin(), log.rows.begin() + 900);
  const std::vector<MeasuredRow> second(log.rows.begin() + 900, log.rows.end());
  StreamOptions options = streamed();
  options.rate = 500.0;
  SampleStream stream = log.stream(options), fresh = log.stream(options);
  stream.restart();  // before anything is known: nothing to forget
  std::vector<Sample> before = drained(stream, first);
  stream.restart();
  const std::vector<Sample> samples = drained(stream, second), alone = drained(fresh, second);
  EXPECT_EQ(stream.segments(), 2U);
  // What waited for the margin comes out with the second part.
  ASSERT_GT(samples.size(), alone.size());
  const std::size_t waited = samples.size() - alone.size();
  for (std::size_t k = 0; k < alone.size(); ++k) expect_same(samples[waited + k], alone[k]);
  EXPECT_LT(samples[waited - 1].time, second.front().time);
}

}  // namespace
}  // namespace shapeid
