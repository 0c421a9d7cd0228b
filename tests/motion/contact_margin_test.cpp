// Flags near a change of contact, against what the header says looked up in the whole log at once.
#include "shapeid/models/contact_margin.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

// Dyadic, so that a sample may lie exactly on the margin.
constexpr double margin_step = 0.125;

std::vector<FlaggedSample> drawn_log() {
  std::vector<FlaggedSample> log;
  double time = 0.0;
  const int contacts = *rc::gen::inRange(1, 4);
  std::vector<int> flags(static_cast<std::size_t>(contacts), 0);
  const int count = *rc::gen::inRange(1, 60);
  for (int k = 0; k < count; ++k) {
    FlaggedSample sample;
    sample.starts_segment = k == 0 || *rc::gen::inRange(0, 12) == 0;
    time += margin_step * *rc::gen::inRange(1, 3);
    sample.sample.time = time;
    if (*rc::gen::inRange(0, 4) == 0) {
      const auto c = static_cast<std::size_t>(*rc::gen::inRange(0, contacts));
      flags[c] = *rc::gen::inRange(-1, 2);
    }
    sample.contacts = flags;
    log.push_back(std::move(sample));
  }
  return log;
}

struct Kept {
  double time;
  std::vector<bool> touches;
  bool operator==(const Kept&) const = default;
};

/// Of one segment.
std::vector<Kept> looked_up(const std::vector<FlaggedSample>& segment, ContactChange change,
                            Margin margin) {
  std::vector<Kept> kept;
  for (const FlaggedSample& here : segment) {
    const double time = here.sample.time;
    Kept result{time, std::vector<bool>(here.contacts.size())};
    bool changes = false;
    for (const FlaggedSample& other : segment) {
      const double later = other.sample.time - time;
      if (later > margin.before || -later > margin.after) continue;
      changes = changes || other.contacts != here.contacts;
      for (std::size_t c = 0; c < here.contacts.size(); ++c) {
        if (other.contacts[c] != 0) result.touches[c] = true;
      }
    }
    const bool known =
        std::find(here.contacts.begin(), here.contacts.end(), -1) == here.contacts.end();
    if (known && !(change == ContactChange::drop && changes)) kept.push_back(std::move(result));
  }
  return kept;
}

RC_GTEST_PROP(ContactMargin, EqualsALookUpInTheWholeLog, ()) {
  const std::vector<FlaggedSample> log = drawn_log();
  const auto change = *rc::gen::element(ContactChange::widen, ContactChange::drop);
  const Margin margin{margin_step * *rc::gen::inRange(0, 5), margin_step * *rc::gen::inRange(0, 5)};
  ContactMargin tested(change, margin);
  std::vector<Kept> out;
  std::size_t pushed = 0;
  const auto collect = [&] {
    while (const std::optional<Sample> sample = tested.next()) {
      out.push_back({sample->time, sample->in_contact});
    }
  };
  std::vector<Kept> expected;
  std::vector<FlaggedSample> segment;
  for (const FlaggedSample& sample : log) {
    if (sample.starts_segment) {
      for (Kept& kept : looked_up(segment, change, margin)) expected.push_back(std::move(kept));
      segment.clear();
    }
    segment.push_back(sample);
    tested.push(sample);
    ++pushed;
    collect();
    // All that the samples so far decide is out, and no more.
    std::size_t decided = pushed;
    for (const FlaggedSample& s : segment) {
      if (s.sample.time + margin.before > sample.sample.time) --decided;
    }
    RC_ASSERT(out.size() + tested.dropped() == decided);
  }
  for (Kept& kept : looked_up(segment, change, margin)) expected.push_back(std::move(kept));
  tested.finish();
  collect();
  RC_ASSERT(out == expected);
  RC_ASSERT(tested.dropped() + out.size() == log.size());
}

/// A margin of whole steps ends at a sample, whose time is rounded otherwise every day.
TEST(ContactMargin, TheTimeOfDayChangesNoFlag) {
  constexpr double step = 0.002;
  constexpr int rows = 200;
  const auto flags_from = [](double begins) {
    ContactMargin margin(ContactChange::widen, {12 * step, 20 * step});
    std::vector<bool> touches;
    for (int k = 0; k < rows; ++k) {
      FlaggedSample sample;
      sample.sample.time = begins + step * k;
      sample.contacts = {k >= 80 && k < 100 ? 1 : 0};
      margin.push(std::move(sample));
    }
    margin.finish();
    while (const std::optional<Sample> sample = margin.next()) {
      touches.push_back(sample->in_contact.front());
    }
    return touches;
  };
  std::vector<bool> expected(rows, false);
  std::fill(expected.begin() + 80 - 12, expected.begin() + 100 + 20, true);
  for (const double begins : {0.0, 0.1, 4.1, 1234.567, 86399.9, 1.7e9}) {
    EXPECT_EQ(flags_from(begins), expected) << begins;
  }
}

// A foot that touched before a gap says nothing about the samples after it.
TEST(ContactMargin, NothingCountsAcrossAGapOfTheLog) {
  const test::ScratchFolder scratch;
  const auto path = scratch.path("x.csv");
  Robot robot = test::chain(2, Root::floating);
  robot.contacts.push_back({"l1", 2, ContactKind::point, Eigen::Isometry3d::Identity()});
  constexpr double gap_from = 2.0, gap_to = 2.1;
  std::vector<double> times;
  for (const double t : test::regular_times(0.0, 500.0, 2000)) {
    if (t <= gap_from || t >= gap_to) times.push_back(t);
  }
  test::write_log(path, robot, times, [&](double t) {
    Sample s = test::smooth_motion(robot, t);
    s.in_contact = {t <= gap_from};
    return s;
  });
  MotionOptions options;
  options.contact_margin = 0.5;
  const test::ReadMotion motion = test::read_motion(path, robot, options);
  EXPECT_EQ(motion.report.gaps, 1U);
  int before = 0, after = 0;
  for (const Sample& sample : motion.samples) {
    EXPECT_EQ(sample.in_contact.at(0), sample.time <= gap_from) << sample.time;
    ++(sample.time <= gap_from ? before : after);
  }
  EXPECT_GT(before, 500);
  EXPECT_GT(after, 500);
}

}  // namespace
}  // namespace shapeid
