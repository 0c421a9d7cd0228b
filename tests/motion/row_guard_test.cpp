// What the guard of a stream takes out, to the row: the numbers are those of row_guard.hpp.
#include "shapeid/models/row_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <set>

namespace shapeid {
namespace {

constexpr double lost_value = std::numeric_limits<double>::quiet_NaN();
constexpr double largest = 10.0;
// Rows of a swing: so slow that neighbours differ by 1.6 percent of the largest value.
constexpr int swing = 400;
// Rows into the log, at a zero of the first channel: all that can be learned is.
constexpr int later = 2 * swing;

/// Channels of joints only: positions first, then torques.
ChannelPlan joints_plan(std::size_t joints) {
  ChannelPlan plan;
  plan.channels.resize(2 * joints);
  plan.q = 0;
  plan.tau = static_cast<int>(joints);
  return plan;
}

using Signal = std::function<double(int row, int channel)>;

double sine(int row, int channel) {
  return largest * std::sin(2.0 * std::numbers::pi * row / swing + channel);
}

/// Zero, and every twentieth row the largest value: what is ordinary is far from its neighbours.
double spikes(int row, int /*channel*/) { return row % 20 == 0 ? largest : 0.0; }

MeasuredRow row_of(const ChannelPlan& plan, const Signal& signal, int number) {
  MeasuredRow row;
  row.line = number;
  row.time = 0.002 * number;
  row.values.resize(static_cast<Eigen::Index>(plan.channels.size()));
  for (int c = 0; c < row.values.size(); ++c) row.values[c] = signal(number, c);
  return row;
}

std::vector<GuardedRow> guarded(const ChannelPlan& plan, std::size_t joints, const Signal& signal,
                                int rows) {
  RowGuard guard(plan, joints);
  std::vector<GuardedRow> out;
  for (int k = 0; k < rows; ++k) {
    guard.push(row_of(plan, signal, k));
    while (std::optional<GuardedRow> row = guard.next()) out.push_back(std::move(*row));
  }
  guard.flush();
  while (std::optional<GuardedRow> row = guard.next()) out.push_back(std::move(*row));
  return out;
}

using Places = std::set<std::pair<int, int>>;  // row, channel

struct Found {
  Places outliers, stuck, saturated;
  bool operator==(const Found&) const = default;
};

void PrintTo(const Found& f, std::ostream* out) {
  *out << "outliers " << testing::PrintToString(f.outliers) << ", stuck "
       << testing::PrintToString(f.stuck) << ", saturated " << testing::PrintToString(f.saturated);
}

/// What was found; whatever is named is missing, and nothing else is touched.
Found found(const ChannelPlan& plan, std::size_t joints, const Signal& signal, int rows = 1200) {
  const std::vector<GuardedRow> out = guarded(plan, joints, signal, rows);
  EXPECT_EQ(out.size(), static_cast<std::size_t>(rows));
  Found all;
  for (int k = 0; k < static_cast<int>(out.size()); ++k) {
    const GuardedRow& row = out[static_cast<std::size_t>(k)];
    EXPECT_EQ(row.row.line, k);
    for (const int c : row.faults.outliers) EXPECT_TRUE(all.outliers.insert({k, c}).second);
    for (const int c : row.faults.stuck) EXPECT_TRUE(all.stuck.insert({k, c}).second);
    for (const int c : row.faults.saturated) EXPECT_TRUE(all.saturated.insert({k, c}).second);
    for (int c = 0; c < row.row.values.size(); ++c) {
      const std::pair<int, int> place = {k, c};
      const bool named = all.outliers.contains(place) || all.stuck.contains(place) ||
                         all.saturated.contains(place);
      const double value = row.row.values[c], given = signal(k, c);
      EXPECT_TRUE(named || std::isnan(given) ? std::isnan(value) : value == given) << k << " " << c;
    }
  }
  return all;
}

Signal with(const Signal& signal, const Places& places, double value) {
  return [=](int row, int channel) {
    return places.contains({row, channel}) ? value : signal(row, channel);
  };
}

Places block(int first, int count, int channel) {
  Places places;
  for (int k = 0; k < count; ++k) places.insert({first + k, channel});
  return places;
}

/// The channel repeats its value of row `first` so many rows long.
Signal repeating(const Signal& signal, int first, int rows, int channel) {
  return with(signal, block(first, rows, channel), signal(first, channel));
}

TEST(RowGuard, RowsAreHeldBackUntilReachNewerOnesAreThere) {
  const ChannelPlan plan = joints_plan(2);
  RowGuard guard(plan, 2);
  int out = 0;
  for (int k = 0; k < 50; ++k) {
    guard.push(row_of(plan, sine, k));
    while (const std::optional<GuardedRow> row = guard.next()) EXPECT_EQ(row->row.line, out++);
    EXPECT_EQ(out, std::max(0, k + 1 - static_cast<int>(RowGuard::reach)));
  }
}

TEST(RowGuard, OrdinaryMotionPasses) {
  EXPECT_EQ(found(joints_plan(3), 3, sine), Found{});
  EXPECT_EQ(found(joints_plan(1), 1, spikes), Found{});
}

TEST(RowGuard, ThirtyPercentOfTheLargestValueAreHarmless) {
  const ChannelPlan plan = joints_plan(1);
  for (const int channel : {0, 1}) {
    const int row = later + 3 + channel;
    const double ordinary = sine(row, channel);
    for (const double sign : {-1.0, 1.0}) {
      const auto at = [&](double share) {
        return found(plan, 1, with(sine, {{row, channel}}, ordinary + sign * share * largest));
      };
      EXPECT_EQ(at(0.29), Found{});
      // The median is one neighbour aside, 1.6 percent.
      EXPECT_EQ(at(0.32), (Found{{{row, channel}}, {}, {}}));
    }
  }
}

TEST(RowGuard, AnOutlierIsFarAgainstOrdinaryRows) {
  const ChannelPlan plan = joints_plan(1);
  const int row = later + 10;
  const auto at = [&](double distance) {
    return found(plan, 1, with(spikes, {{row, 1}}, distance * largest));
  };
  EXPECT_EQ(at(0.99 * RowGuard::far), Found{});
  EXPECT_EQ(at(1.01 * RowGuard::far), (Found{{{row, 1}}, {}, {}}));
  EXPECT_EQ(at(-1.01 * RowGuard::far), (Found{{{row, 1}}, {}, {}}));
}

// Five thousand rows after the last spike the limit has come down by 1 / e.
TEST(RowGuard, WhatWasOrdinaryLongAgoIsForgotten) {
  const ChannelPlan plan = joints_plan(1);
  const int row = later + 5000;
  const double limit = RowGuard::far * largest * std::exp(-1.0);
  const auto at = [&](double value) {
    const Signal quiet = [](int k, int c) { return k <= later ? spikes(k, c) : 0.0; };
    return found(plan, 1, with(quiet, {{row, 0}}, value), row + 100);
  };
  EXPECT_EQ(at(0.99 * limit), Found{});
  EXPECT_EQ(at(1.01 * limit), (Found{{{row, 0}}, {}, {}}));
}

// Each outlier makes a channel less strict by a fifth, so that a new kind of motion loses a handful
// of rows: 0.3 and 0.5 of the largest value are three such steps apart, 4 and 5.5 times what was
// ordinary two.
TEST(RowGuard, ANewKindOfMotionIsLearned) {
  const ChannelPlan plan = joints_plan(1);
  const auto every_twentieth = [](const Signal& before, double value) {
    return [=](int k, int c) { return c == 0 && k > later && k % 20 == 10 ? value : before(k, c); };
  };
  const Signal still = [](int k, int c) { return k < swing ? sine(k, c) : 0.0; };
  EXPECT_EQ(found(plan, 1, every_twentieth(still, 0.5 * largest)),
            (Found{{{later + 10, 0}, {later + 30, 0}, {later + 50, 0}}, {}, {}}));
  EXPECT_EQ(found(plan, 1, every_twentieth(spikes, 5.5 * largest)),
            (Found{{{later + 10, 0}, {later + 30, 0}}, {}, {}}));
}

// Seven rows are compared: three may be outliers, four are a motion.
TEST(RowGuard, OutliersAreFewerThanTheirNeighbours) {
  const ChannelPlan plan = joints_plan(1);
  for (const double value : {-8.0, 8.0}) {
    EXPECT_EQ(found(plan, 1, with(sine, block(later, 3, 0), value)),
              (Found{block(later, 3, 0), {}, {}}));
    EXPECT_EQ(found(plan, 1, with(sine, block(later, 4, 0), value)), Found{});
  }
}

TEST(RowGuard, ASlowChannelIsComparedWithItsOwnMeasurements) {
  const ChannelPlan plan = joints_plan(1);
  const Signal every_other = [](int k, int c) { return k % 2 == c ? sine(k, c) : lost_value; };
  EXPECT_EQ(found(plan, 1, every_other), Found{});
  EXPECT_EQ(found(plan, 1, with(every_other, {{later, 0}}, 5.0)), (Found{{{later, 0}}, {}, {}}));
}

TEST(RowGuard, NothingIsJudgedBeforeAllIsLearned) {
  const ChannelPlan plan = joints_plan(4);
  // A row is judged when three newer ones are there.
  const int first = static_cast<int>(RowGuard::learning - RowGuard::half);
  const auto outlier = [&](int row) {
    return found(plan, 4, with(sine, {{row, 2}}, sine(row, 2) > 0.0 ? -9.0 : 9.0));
  };
  EXPECT_EQ(outlier(first - 1), Found{});
  EXPECT_EQ(outlier(first), (Found{{{first, 2}}, {}, {}}));
  const int last = static_cast<int>(RowGuard::learning);
  EXPECT_EQ(found(plan, 4, repeating(sine, last - 30, 30, 1)), Found{});
}

TEST(RowGuard, AChannelIsStuckWhenItRepeatsItselfReachTimes) {
  const ChannelPlan plan = joints_plan(4);
  const int reach = RowGuard::reach;
  for (const int channel : {0, 1, 3, 4, 7}) {
    EXPECT_EQ(found(plan, 4, repeating(sine, later + 5, reach - 1, channel)), Found{});
    for (const int rows : {reach, 100}) {
      EXPECT_EQ(found(plan, 4, repeating(sine, later + 5, rows, channel)),
                (Found{{}, block(later + 5, rows, channel), {}}));
    }
  }
}

// And four times as long as it ever did by nature; by then the first rows of the run have been
// handed on.
TEST(RowGuard, ARunIsUnnaturalAgainstTheLongestThatWasLearned) {
  const ChannelPlan plan = joints_plan(4);
  const int reach = RowGuard::reach, repeats = 5, most = 4 * repeats;
  const Signal natural = repeating(repeating(sine, 100, repeats + 1, 2), 300, repeats - 1, 2);
  EXPECT_EQ(found(plan, 4, repeating(natural, later + 7, most, 2)), Found{});
  EXPECT_EQ(found(plan, 4, repeating(natural, later + 7, most + 1, 2)),
            (Found{{}, block(later + 7 + most - reach, reach + 1, 2), {}}));
}

TEST(RowGuard, AtItsLargestMagnitudeAStuckChannelIsSaturated) {
  const ChannelPlan plan = joints_plan(4);
  for (const double sign : {-1.0, 1.0}) {
    const int peak = later + swing / 2 + (sign > 0.0 ? -1 : 1) * swing / 4 - 6;
    const Places places = block(peak, 14, 0);
    EXPECT_EQ(found(plan, 4, with(sine, places, sign * 1.001 * largest)), (Found{{}, {}, places}));
    EXPECT_EQ(found(plan, 4, with(sine, places, sign * 0.995 * largest)), (Found{{}, places, {}}));
  }
}

TEST(RowGuard, ZeroIsNeverStuck) {
  EXPECT_EQ(found(joints_plan(4), 4, with(sine, block(later, 100, 0), 0.0)), Found{});
}

// A robot that stands still repeats itself, too: most channels of the kind must go on.
TEST(RowGuard, OnlyWhatStandsStillAloneIsStuck) {
  const auto still = [](std::size_t joints, const std::set<int>& channels) {
    Signal signal = sine;
    Places places;
    for (const int c : channels) {
      signal = repeating(signal, later + 5, 20, c);
      places.merge(block(later + 5, 20, c));
    }
    return std::pair(found(joints_plan(joints), joints, signal), Found{{}, places, {}});
  };
  const auto two_of_four = still(4, {1, 2});
  EXPECT_EQ(two_of_four.first, two_of_four.second);
  EXPECT_EQ(still(4, {0, 1, 2}).first, Found{});
  EXPECT_EQ(still(3, {0, 2}).first, Found{});
  EXPECT_EQ(still(3, {0, 1, 2}).first, Found{});
  const auto positions_and_torques = still(3, {1, 5});
  EXPECT_EQ(positions_and_torques.first, positions_and_torques.second);
}

TEST(RowGuard, AxesOfAnImuAreAKindOfTheirOwn) {
  ChannelPlan plan;
  plan.channels.resize(12);
  plan.gyro = 0;
  plan.accel = 3;
  plan.q = 6;
  plan.dq = 8;  // not judged
  plan.tau = 10;
  EXPECT_EQ(found(plan, 2, sine), Found{});
  for (const int axis : {0, 2, 3, 5}) {
    EXPECT_EQ(found(plan, 2, repeating(sine, later + 5, 20, axis)),
              (Found{{}, block(later + 5, 20, axis), {}}));
  }
  EXPECT_EQ(found(plan, 2, repeating(repeating(sine, later + 5, 20, 3), later + 5, 20, 4)),
            Found{});
  for (const int velocity : {8, 9}) {
    EXPECT_EQ(found(plan, 2, repeating(sine, later + 5, 20, velocity)), Found{});
    EXPECT_EQ(found(plan, 2, with(sine, {{later, velocity}}, 50.0)), Found{});
  }
}

// A channel that is held repeats itself by nature, and jumps where it does not.
TEST(RowGuard, HeldChannelsAreNotJudged) {
  ChannelPlan plan = joints_plan(4);
  plan.channels[1].hold_group = 0;
  EXPECT_EQ(found(plan, 4, repeating(sine, later + 5, 50, 1)), Found{});
  EXPECT_EQ(found(plan, 4, with(sine, {{later, 1}}, 50.0)), Found{});
}

// After a gap in the log nothing of before is repeated, and what was learned is not forgotten.
TEST(RowGuard, ARunEndsWhereTheLogIsInterrupted) {
  const ChannelPlan plan = joints_plan(4);
  const int reach = RowGuard::reach, first = later + 5;
  const Signal signal = with(repeating(sine, first, 2 * (reach - 1), 1), {{first + 60, 3}}, 30.0);
  RowGuard guard(plan, 4);
  Found all;
  int out = 0;
  const auto collect = [&] {
    while (const std::optional<GuardedRow> row = guard.next()) {
      EXPECT_EQ(row->row.line, out++);
      for (const int c : row->faults.outliers) all.outliers.insert({row->row.line, c});
      EXPECT_TRUE(row->faults.stuck.empty() && row->faults.saturated.empty());
    }
  };
  for (int k = 0; k < first + 100; ++k) {
    if (k == first + reach - 1) {
      guard.flush();
      collect();
      EXPECT_EQ(out, k);
    }
    guard.push(row_of(plan, signal, k));
    collect();
  }
  EXPECT_EQ(all.outliers, (Places{{first + 60, 3}}));
}

}  // namespace
}  // namespace shapeid
