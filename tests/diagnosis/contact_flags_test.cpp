// Flags of contacts that come late or go early: found, and corrected so that the force is projected
// away.
#include "shapeid/diagnosis/contact_flags.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/diagnosis/trot.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::diagnosis {
namespace {

using test::Trot;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// At 100 Hz, with a sample missing where there is a bar: x touches.
Recording flags(const std::string& pattern) {
  std::vector<Sample> samples;
  double time = 0.0;
  for (const char c : pattern) {
    if (c != '|') {
      Sample s;
      s.time = time;
      s.in_contact = {true, c == 'x'};
      samples.push_back(s);
    }
    time += 0.01;
  }
  return {std::move(samples), 100.0};
}

TEST(ContactTimes, AreThoseToTheNextSampleThatTouchesInTheSegment) {
  const Recording log = flags("..x.x..|..x.");
  const std::vector<double> since = {infinity, infinity, 0.0,      0.01, 0.0, 0.01,
                                     0.02,     infinity, infinity, 0.0,  0.01};
  const std::vector<double> until = {0.02,     0.01, 0.0,  0.01, 0.0,     infinity,
                                     infinity, 0.02, 0.01, 0.0,  infinity};
  ASSERT_EQ(log.samples().size(), since.size());
  constexpr double rounding = 1e-12;  // s, of sums of a few steps
  const auto same = [](double a, double b) { return a == b || std::abs(a - b) < rounding; };
  for (std::size_t i = 0; i < since.size(); ++i) {
    SCOPED_TRACE(i);
    const Surroundings here = log.surroundings(i);
    EXPECT_PRED2(same, here.since_touch[1], since[i]);
    EXPECT_PRED2(same, here.until_touch[1], until[i]);
    EXPECT_EQ(here.since_touch[0], 0.0);
    EXPECT_EQ(here.until_touch[0], 0.0);
  }
}

std::string pattern_of(const Recording& log) {
  std::string pattern;
  for (const Sample& s : log.samples()) pattern += s.in_contact[1] ? 'x' : '.';
  return pattern;
}

TEST(ContactTimes, LengthenedContactsStayInTheirSegment) {
  Recording log = flags("...x....|....x..");
  log.lengthen_contact(1, 0.02, 0.01);
  EXPECT_EQ(pattern_of(log), ".xxxx.....xxxx.");
  EXPECT_EQ(log.surroundings(0).until_touch[1], 0.01) << "times are of the new flags";
}

TEST(ContactTimes, ExtendedContactsLeaveWhatIsDeclared) {
  Recording log = flags("...x.....|...x...");
  log.extend_contacts(0.02, 0.01);
  EXPECT_EQ(pattern_of(log), ".xxxx.....xxxx..");
  EXPECT_DOUBLE_EQ(log.surroundings(2).until_touch[1], 0.01);
  EXPECT_FALSE(log.shifted(1, 0.01).in_contact[1]);
  EXPECT_TRUE(log.shifted(2, 0.01).in_contact[1]);
  log.extend_contacts(0.03, 0.0);
  EXPECT_EQ(pattern_of(log), "xxxxx....xxxxx..")
      << "from what is declared, not from what was extended";
}

TEST(ContactTimes, ExtendedContactsAreTheSameWheneverTheLogBegan) {
  constexpr double rate = 500.0, step = 1.0 / rate;
  const auto touching = [&](double begin) {
    std::vector<Sample> samples(400);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].time = begin + static_cast<double>(i) / rate;
      samples[i].in_contact = {i % 40 < 20};
    }
    Recording log(std::move(samples), rate);
    log.extend_contacts(3.0 * step, 4.0 * step);
    std::vector<bool> touches;
    for (const Sample& s : log.samples()) touches.push_back(s.in_contact[0]);
    return touches;
  };
  const std::vector<bool> at_zero = touching(0.0);
  for (const double begin : {37.5, 1e6, 1e9, 1.7e9}) {
    SCOPED_TRACE(begin);
    EXPECT_EQ(touching(begin), at_zero);
  }
}

/// On the log as it was, the effect says what lengthening the log's contact says.
RC_GTEST_PROP(ContactFlags, AreTheSameAsAnEffectAndCorrectedInTheLog, ()) {
  const Robot robot = *test::robot({2, 5, Root::floating});
  RC_PRE(!robot.contacts.empty());
  Sample sample = *test::sample(robot);
  sample.in_contact.assign(robot.contacts.size(), false);
  const std::vector<int> touches =
      *rc::gen::container<std::vector<int>>(40, rc::gen::weightedElement<int>({{4, 0}, {1, 1}}));
  const auto contact = *rc::gen::inRange<std::size_t>(0, robot.contacts.size());
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    sample.time = 0.01 * static_cast<double>(i);
    sample.in_contact[contact] = touches[i] == 1;
    samples.push_back(sample);
  }
  const Recording log(std::move(samples), 100.0);
  const bool late = *rc::gen::arbitrary<bool>();
  AppliedEffect effect =
      at_start(*find_effect(late ? "contact_late" : "contact_short"), static_cast<int>(contact));
  effect.value[0] = 0.001 * *rc::gen::inRange(0, 80);
  Recording lengthened = log;
  correct_contact_flags(lengthened, {Found{effect, "", Eigen::VectorXd::Zero(1)}});
  const Viewer viewer(robot, ContactTreatment::project, {effect});
  const Viewer plain(robot, ContactTreatment::project, {});
  for (std::size_t i = 0; i < log.samples().size(); ++i) {
    const View as_effect = viewer.view(log, i), corrected = plain.view(lengthened, i);
    RC_ASSERT(as_effect.sample.in_contact == corrected.sample.in_contact);
    RC_ASSERT(as_effect.J == corrected.J);
  }
}

void expect_found(const Trot& trot, Recording log, const std::string& id, double time) {
  const std::vector<Found> found =
      correct_contact_flags(trot.robot, log, nullptr, {}, trot.settings());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].id, id);
  // Searched in steps of one and a half, and rounded up by a fifth.
  EXPECT_GT(found[0].effect.value[0], time / 1.5);
  EXPECT_LT(found[0].effect.value[0], time * 1.5 * 1.2 * 1.01);
  EXPECT_GT(found[0].gain, 0.5) << "it is most of what the rigid robot leaves";
}

TEST(ContactFlags, AreFoundOnATrotWhereTheyAreWrong) {
  const Trot trot;
  Recording right = trot.told(2, 0.0, 0.0);
  EXPECT_TRUE(correct_contact_flags(trot.robot, right, nullptr, {}, trot.settings()).empty());
  expect_found(trot, trot.told(2, 0.016, 0.0), "contact_late@RR_foot", 0.016);
  expect_found(trot, trot.told(1, 0.0, 0.024), "contact_short@FL_foot", 0.024);
}

/// All inertias and torques six times as large: the same robot in other units. Forces were believed
/// up to a hundred newtons once, and another foot's flag was moved by 84 ms.
TEST(ContactFlags, AreFoundOnAHeavyRobotAsOnALightOne) {
  constexpr double times = 6.0;
  Trot trot;
  for (Link& link : trot.robot.links) link.inertia.values *= times;
  for (Sample& s : trot.samples) s.tau *= times;
  expect_found(trot, trot.told(2, 0.016, 0.0), "contact_late@RR_foot", 0.016);
}

TEST(ContactFlags, TheGroundCannotPull) {
  std::vector<Sample> samples(3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time = 0.01 * static_cast<double>(i);
    samples[i].base_specific_force = Eigen::Vector3d(2.0, 0.0, 9.0);  // a base on a slope
  }
  const Recording log(std::move(samples), 100.0);
  EXPECT_TRUE(pushes(log, {1.0, 5.0, 0.0}));
  EXPECT_FALSE(pushes(log, {-5.0, 0.0, 1.0}));
}

/// Seed 9582, trial 47: of a flexible hip the swing was told as a contact that is 120 ms late, most
/// of the time that the foot is in the air.
TEST(ContactFlags, AFootThatSwingsDoesNotTouch) {
  const Trot trot;
  const auto flag = [](const char* id, int foot, double time) {
    return test::effect(id, foot, {time});
  };
  const Recording late = trot.told(2, 0.016, 0.0), early = trot.told(1, 0.0, 0.024);
  EXPECT_FALSE(swings(trot.robot, late, flag("contact_late", 2, 0.016)));
  EXPECT_FALSE(swings(trot.robot, early, flag("contact_short", 1, 0.024)));
  const Recording right = trot.told(2, 0.0, 0.0);
  for (const double time : {0.084, 0.12}) {
    EXPECT_TRUE(swings(trot.robot, right, flag("contact_late", 2, time))) << time;
    EXPECT_TRUE(swings(trot.robot, right, flag("contact_short", 1, time))) << time;
  }
}

TEST(ContactFlags, AContactThatWouldPullHasNoName) {
  const Trot trot;
  const LoopSettings settings = trot.settings();
  LoopState state(trot.robot, trot.told(2, 0.0, 0.0), nullptr, settings);
  state.fit_masses();
  const auto claim = [&](const std::string& id, int site, double up) {
    const AppliedEffect a = test::effect(id, site, {1.0, 0.5, up});
    state.result.found.push_back({a, id, Eigen::VectorXd::Ones(3)});
    state.result.model.effects.push_back(a);
  };
  claim("contact_undeclared", 2, -12.0);
  claim("contact_undeclared", 1, 12.0);
  claim("external_force", trot.robot.contacts[0].link, -12.0);  // of no ground: it may pull
  question_names(state);
  EXPECT_TRUE(state.result.found[0].pulls);
  EXPECT_FALSE(state.result.found[0].name_stands());
  EXPECT_FALSE(state.result.found[1].pulls);
  EXPECT_FALSE(state.result.found[2].pulls);
}

}  // namespace
}  // namespace shapeid::diagnosis
