// Torques that were held, or never logged, while the joint moved on, and such that only rest.
#include "shapeid/models/held_torques.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::test {
namespace {

using Change = std::function<void(double, Sample&)>;

/// What a report notes of a log of 6 s that `change` makes other samples of.
std::vector<std::string> noted(const Change& change, const std::vector<double>& times) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder folder;
  const std::string path = folder.path("log.csv");
  write_log(path, robot, times, [&](double time) {
    Sample sample = smooth_motion(robot, time);
    change(time, sample);
    return sample;
  });
  return read_motion(path, robot).report.notes;
}

std::vector<std::string> noted(const Change& change) {
  return noted(change, regular_times(0.0, 500.0, 3000));
}

TEST(HeldTorques, AreNotedByTheLongest) {
  Eigen::VectorXd last;
  const auto hold = [&](double time, Sample& s) {
    if (time > 2.0 && time < 2.6) s.tau[1] = last[1];
    if (time > 4.0 && time < 4.4) s.tau[1] = 0.0;
    last = s.tau;
  };
  const auto notes = noted(hold);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("log.csv:1002: tau.j1 stays at "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" for 0.6 s while the joint moves by "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" rad (2 times): leave these rows out"), std::string::npos) << notes[0];
}

/// One that goes on to the log's end as well.
TEST(HeldTorques, TheLastCounts) {
  Eigen::VectorXd last;
  const auto notes = noted([&](double time, Sample& s) {
    if (time > 5.0) s.tau[2] = last[2];
    last = s.tau;
  });
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("tau.j2 stays at "), std::string::npos) << notes[0];
  EXPECT_NE(notes[0].find(" for 1 s "), std::string::npos) << notes[0];
}

/// A drive at its limit, a coarse reading, a joint that stands, and rows that are missing.
TEST(HeldTorques, WhatMayStayIsNone) {
  const auto limited = [](double, Sample& s) { s.tau = s.tau.cwiseMax(-0.3).cwiseMin(0.3); };
  for (const std::string& note : noted(limited)) {
    EXPECT_NE(note.find("is it saturated?"), std::string::npos) << note;
  }
  const auto coarse = [](double, Sample& s) { s.tau = (s.tau * 50.0).array().round() / 50.0; };
  EXPECT_TRUE(noted(coarse).empty());
  const auto coarse_at_constant_speed = [](double time, Sample& s) {
    s.q[1] = 0.4 * time;
    s.tau[1] = 0.05 * std::round(2.0 * std::sin(time) + 0.2 * std::sin(40.0 * time));
  };
  EXPECT_TRUE(noted(coarse_at_constant_speed).empty());
  const auto stands = [](double time, Sample& s) {
    if (time < 1.0) s.tau[0] = 0.1;
    s.q[0] = 0.3;
    if (time >= 1.0) s.q[0] += 0.2 * (1.0 - std::cos(2.0 * (time - 1.0)));
  };
  EXPECT_TRUE(noted(stands).empty());
  std::vector<double> times = regular_times(0.0, 500.0, 3000);
  std::erase_if(times, [](double t) { return t > 2.05 && t < 2.55; });
  Eigen::VectorXd last;
  const auto hold = [&](double time, Sample& s) {
    if (time > 2.0 && time < 2.6) s.tau[1] = last[1];
    last = s.tau;
  };
  EXPECT_TRUE(noted(hold, times).empty());
}

TEST(HeldTorques, ZeroThroughoutIsAJointThatNothingDrives) {
  const auto silent = [](double, Sample& s) { s.tau[1] = 0.0; };
  const std::vector<std::string> note = {
      "tau.j1 is zero in every row while j1 moves: taken for a joint that nothing drives"};
  EXPECT_EQ(noted(silent), note);
  EXPECT_TRUE(noted([](double, Sample& s) {
                s.tau[1] = s.dq[1] = 0.0;
                s.q[1] = 0.2;
              }).empty());
}

}  // namespace
}  // namespace shapeid::test
