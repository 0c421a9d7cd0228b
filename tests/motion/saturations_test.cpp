// Readings that end where a sensor does, and such that only come often.
#include "shapeid/models/saturations.hpp"

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

/// What a report notes of a log of 8 s whose samples `change` makes others of.
std::vector<std::string> noted(Root root, const std::function<void(double, Sample&)>& change) {
  const Robot robot = chain(2, root);
  const ScratchFolder folder;
  const std::string path = folder.path("log.csv");
  write_log(path, robot, regular_times(0.0, 500.0, 4000), [&](double time) {
    Sample sample = smooth_motion(robot, time);
    change(time, sample);
    return sample;
  });
  return read_motion(path, robot).report.notes;
}

TEST(Saturations, AreNotedWithTheirEnd) {
  const auto torque = noted(Root::fixed, [](double time, Sample& s) {
    s.tau[1] = std::clamp(std::sin(4.0 * time), -0.75, 2.0);
  });
  ASSERT_EQ(torque.size(), 1U);
  EXPECT_EQ(torque[0].rfind("tau.j1 comes back to -0.75 and stays there, in 2", 0), 0U)
      << torque[0];
  const auto both = noted(Root::floating, [](double time, Sample& s) {
    s.base_angular_velocity.y() = std::clamp(std::sin(5.0 * time), -0.9, 0.9);
  });
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].rfind("base.gyro.y comes back to -0.9 ", 0), 0U) << both[0];
  EXPECT_EQ(both[1].rfind("base.gyro.y comes back to 0.9 ", 0), 0U) << both[1];
}

/// Coarse steps of round peaks, a joint without load, one that rests at its largest torque, and an
/// end that is passed once, at the last.
TEST(Saturations, AreNotSeenWhereReadingsAreOnlyTheSame) {
  const auto none = [](const std::function<double(double)>& torque) {
    const auto notes = noted(Root::fixed, [&](double time, Sample& s) { s.tau[1] = torque(time); });
    return std::ranges::none_of(
        notes, [](const std::string& note) { return note.find("saturated") != std::string::npos; });
  };
  EXPECT_TRUE(none([](double t) { return std::round(40.0 * std::sin(4.0 * t)) / 40.0; }));
  EXPECT_TRUE(none([](double t) {
    return std::round(40.0 * (std::sin(4.0 * t) + 0.3 * std::sin(17.0 * t + 1.0))) / 40.0;
  }));
  EXPECT_TRUE(none([](double t) { return std::max(std::sin(4.0 * t), 0.0); }));
  EXPECT_TRUE(none([](double t) { return t < 1.0 ? 1.5 : std::sin(4.0 * t); }));
  EXPECT_TRUE(
      none([](double t) { return t > 7.9 ? -0.9 : std::clamp(std::sin(4.0 * t), -0.75, 2.0); }));
}

}  // namespace
}  // namespace shapeid::test
