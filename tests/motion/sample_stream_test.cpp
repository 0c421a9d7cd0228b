// Rows pushed in one by one give the samples that a causal reader makes of the whole log.
#include "shapeid/models/sample_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "shapeid/models/error.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::few_hundred_eps;
using test::read_motion;
using test::scaled;
using test::ScratchFolder;
using test::smooth_motion;

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
  constexpr int count = 3000;
  std::vector<double> times;
  times.reserve(count);
  for (int k = 0; k < count; ++k) {
    times.push_back(0.002 * k + 0.0004 * std::sin(1.7 * k) + (k < 1400 ? 0.0 : 0.1));
  }
  return times;
}

/// With forces that are measured at the contacts and a column that is nobody's.
Sample stepping(const Robot& robot, double t) {
  Sample s = smooth_motion(robot, t);
  s.in_contact.assign(robot.contacts.size(), std::sin(5.0 * t) > 0.0);
  s.contact_force.assign(robot.contacts.size(),
                         {4.0 * std::sin(6.0 * t), 7.0 * std::cos(9.0 * t), 50.0 + 20.0 * s.q[0]});
  s.extra = {20.0 + t};
  return s;
}

void write_stepping(const std::string& path, const Robot& robot, const std::vector<double>& times,
                    const std::function<Sample(double)>& motion) {
  std::vector<std::string> columns = test::log_columns(robot);
  for (const Contact& contact : robot.contacts) {
    for (const char* axis : {".x", ".y", ".z"}) columns.push_back("force." + contact.name + axis);
  }
  columns.emplace_back("temperature");
  LogWriter writer(path, columns);
  for (const double time : times) {
    const Sample s = motion(time);
    std::vector<double> row = test::log_row(robot, s);
    for (const Eigen::Vector3d& force : s.contact_force) {
      row.insert(row.end(), force.begin(), force.end());
    }
    row.insert(row.end(), s.extra.begin(), s.extra.end());
    writer.write(row);
  }
  writer.close();
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
  EXPECT_EQ(a.contact_force, b.contact_force);
  EXPECT_EQ(a.extra, b.extra);
}

/// A log and the stream that it is pushed into.
struct Streaming {
  ScratchFolder scratch;
  std::string path = scratch.path("x.csv");
  Robot robot;
  std::vector<MeasuredRow> rows;
  ChannelPlan plan;

  Streaming(bool with_contact, const std::vector<double>& times)
      : Streaming(with_contact, times, stepping) {}
  Streaming(bool with_contact, const std::vector<double>& times,
            const std::function<Sample(const Robot&, double)>& motion)
      : robot(walker(with_contact)) {
    write_stepping(path, robot, times, [&](double t) { return motion(robot, t); });
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
      EXPECT_EQ(samples[k].contact_force.size(), log.robot.contacts.size());
      EXPECT_EQ(samples[k].extra.size(), 1U);
    }
  }
}

/// A force and a torque that follow one sine come out as the same sine, as the filter of second
/// order leaves it: with x = tan(pi f / rate) / tan(pi fc / rate), times 1 / (1 - x^2 + i sqrt(2)
/// x).
TEST(SampleStream, MeasuredForcesAreFilteredAsTorquesAre) {
  constexpr double rate = 500.0, frequency = 3.0, size = 40.0;
  constexpr double w = 2.0 * std::numbers::pi * frequency;
  const Streaming log(true, test::regular_times(0.0, rate, 2000), [](const Robot& robot, double t) {
    Sample s = stepping(robot, t);
    s.in_contact = {true};
    s.tau[0] = size * std::sin(w * t);
    s.contact_force = {{s.tau[0], -s.tau[0], 2.0 * s.tau[0]}};
    return s;
  });
  StreamOptions options = streamed();
  options.rate = rate;
  SampleStream stream = log.stream(options);
  const double x =
      std::tan(std::numbers::pi * frequency / rate) / std::tan(std::numbers::pi * cutoff / rate);
  const std::complex<double> response = 1.0 / std::complex(1.0 - x * x, std::sqrt(2.0) * x);
  std::size_t settled = 0;
  for (const Sample& s : drained(stream, log.rows)) {
    if (s.time < 2.0) continue;  // what came in at the start has decayed below any rounding
    ++settled;
    const double wanted = size * std::abs(response) * std::sin(w * s.time + std::arg(response));
    ASSERT_EQ(s.contact_force.size(), 1U);
    const Eigen::Vector3d error =
        s.contact_force[0] - Eigen::Vector3d(wanted, -wanted, 2.0 * wanted);
    EXPECT_LT(scaled(error.norm(), size * (1.0 + w * s.time), 2), few_hundred_eps) << s.time;
    EXPECT_EQ(s.contact_force[0].x(), s.tau[0]);
  }
  EXPECT_GT(settled, 500U);
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

/// A channel that goes on in every fourth row alone holds a sample up twice: for its next value,
/// and for the one behind that, which shapes its curve.
TEST(SampleStream, NoSampleIsOlderThanItsLatency) {
  Streaming log(false, test::regular_times(0.0, 500.0, 4000));
  for (std::size_t i = 2000; i < log.rows.size(); ++i) {
    if (i % 4 != 0) log.rows[i].values[log.plan.tau] = std::numeric_limits<double>::quiet_NaN();
  }
  SampleStream stream = log.stream(streamed());
  double oldest = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    stream.push(log.rows[i]);
    while (const std::optional<Sample> sample = stream.next()) {
      ++count;
      if (i > SampleStream::head_rows) oldest = std::max(oldest, log.rows[i].time - sample->time);
    }
  }
  EXPECT_GT(count, 3900U);
  EXPECT_LE(oldest, stream.latency());
}

/// A measured force that no robot meets is named, before torques beside it are.
TEST(SampleStream, AForceThatNoRobotMeetsIsRefused) {
  const auto received = [](double force) -> std::string {
    const auto pushed = [force](const Robot& robot, double t) {
      Sample s = stepping(robot, t);
      if (std::abs(t - 1.0) < 1e-4) s.contact_force.at(0).x() = force;
      return s;
    };
    try {
      const Streaming log(true, test::regular_times(0.0, 500.0, 2000), pushed);
      static_cast<void>(read_motion(log.path, log.robot, causal()));
    } catch (const InputError& e) {
      return e.what();
    }
    return "accepted";
  };
  EXPECT_EQ(received(1e5), "accepted");
  const std::string message = received(-1e7);
  EXPECT_NE(message.find("-1e+07 is no reading of a robot; N, at most 1e+06"), std::string::npos)
      << message;
  EXPECT_NE(message.find("column force."), std::string::npos) << message;
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
