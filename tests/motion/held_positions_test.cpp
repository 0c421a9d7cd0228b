// Positions that were held while the joint moved on, and joints that only rest.
#include "shapeid/models/held_positions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::test {
namespace {

/// What a report notes of a log of 6 s whose positions are what `held` makes of them.
std::vector<std::string> noted(const std::function<void(double, Eigen::VectorXd&)>& held) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder folder;
  const std::string path = folder.path("log.csv");
  write_log(path, robot, regular_times(0.0, 500.0, 3000), [&](double time) {
    Sample sample = smooth_motion(robot, time);
    held(time, sample.q);
    return sample;
  });
  MotionOptions options;
  options.refuse_frozen = false;
  return read_motion(path, robot, options).report.notes;
}

TEST(HeldPositions, AreNotedByWhereTheyBegin) {
  Eigen::VectorXd last;
  const auto hold = [&](double time, Eigen::VectorXd& q) {
    if (time > 2.0 && time < 2.4) q[1] = last[1];
    if (time > 4.0 && time < 4.15) q = last;
    last = q;
  };
  const auto notes = noted(hold);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("log.csv:1002: q.j1 stays the same for 0.4 s and then jumps by "),
            std::string::npos)
      << notes[0];
  EXPECT_NE(notes[0].find(" rad: readings were held (4 times)"), std::string::npos) << notes[0];
}

/// A joint that stands for a second and starts, a coarse encoder, and one that is read every fourth
/// row alone: none goes farther at once than it does else.
TEST(HeldPositions, RestIsNone) {
  const auto rests = [](double time, Eigen::VectorXd& q) {
    if (time < 1.0) q[0] = 0.3;
    if (time >= 1.0) q[0] = 0.3 + 0.2 * (1.0 - std::cos(2.0 * (time - 1.0)));
  };
  EXPECT_TRUE(noted(rests).empty());
  const auto coarse = [](double, Eigen::VectorXd& q) { q = (q * 20.0).array().round() / 20.0; };
  EXPECT_TRUE(noted(coarse).empty());
  Eigen::VectorXd last;
  int row = 0;
  const auto slow = [&](double, Eigen::VectorXd& q) {
    if (row++ % 4 == 0) last = q;
    q = last;
  };
  EXPECT_TRUE(noted(slow).empty());
}

/// While rows are missing a joint goes on, one that rested before as well.
TEST(HeldPositions, AGapIsNone) {
  const Robot robot = chain(3, Root::fixed);
  const ScratchFolder folder;
  const std::string path = folder.path("log.csv");
  std::vector<double> times = regular_times(0.0, 500.0, 3000);
  std::erase_if(times, [](double t) { return (t > 1.0 && t < 1.5) || (t > 4.0 && t < 4.2); });
  write_log(path, robot, times, [&](double time) {
    Sample sample = smooth_motion(robot, time);
    if (time < 1.2) sample.q[1] = 0.7;
    return sample;
  });
  MotionOptions options;
  options.refuse_frozen = false;
  EXPECT_EQ(read_motion(path, robot, options).report.notes, std::vector<std::string>());
}

}  // namespace
}  // namespace shapeid::test
