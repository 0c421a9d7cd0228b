// Measurements that stand in a log twice: a signal under two names, a stretch at two times.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::test {
namespace {

/// What is noted of a log in which a row is what `motion` makes of its number.
std::vector<std::string> notes_of(const Robot& robot, int rows,
                                  const std::function<Sample(int)>& motion) {
  const ScratchFolder folder;
  const std::string path = folder.path("log.csv");
  constexpr double rate = 500.0;
  write_log(path, robot, regular_times(0.0, rate, rows), [&](double time) {
    Sample sample = motion(static_cast<int>(std::lround(time * rate)));
    sample.time = time;
    return sample;
  });
  return read_motion(path, robot).report.notes;
}

bool some_says(const std::vector<std::string>& notes, const std::string& words) {
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

class Copies : public testing::Test {
 protected:
  Robot robot_ = chain(3, Root::floating);
  [[nodiscard]] Sample at(int row) const { return smooth_motion(robot_, 0.002 * row); }
};

TEST_F(Copies, NothingIsSaidOfALogWithoutAny) {
  EXPECT_EQ(notes_of(robot_, 3000, [&](int row) { return at(row); }), std::vector<std::string>());
}

TEST_F(Copies, ASignalUnderTwoNamesIsNoted) {
  const auto exchanged = [&](int row) {
    Sample sample = at(row);
    sample.tau[2] = sample.tau[0];
    sample.base_angular_velocity.z() = sample.base_angular_velocity.x();
    return sample;
  };
  const auto notes = notes_of(robot_, 1000, exchanged);
  EXPECT_EQ(notes.size(), 2U);
  EXPECT_TRUE(some_says(notes, "columns tau.j0 and tau.j2 say the same in every row"));
  EXPECT_TRUE(some_says(notes, "columns base.gyro.x and base.gyro.z say"));
}

/// One row that differs is enough; what rests may well read the same.
TEST_F(Copies, OnlyWhatIsTheSameThroughoutIsNoted) {
  const auto but_for_one = [&](int row) {
    Sample sample = at(row);
    if (row != 777) sample.tau[2] = sample.tau[0];
    return sample;
  };
  EXPECT_TRUE(notes_of(robot_, 1000, but_for_one).empty());
  const auto resting = [&](int row) {
    Sample sample = at(row);
    for (const int j : {1, 2}) sample.q[j] = sample.dq[j] = sample.ddq[j] = sample.tau[j] = 0.0;
    return sample;
  };
  EXPECT_TRUE(notes_of(robot_, 1000, resting).empty());
}

TEST_F(Copies, AStretchThatStandsTwiceIsNoted) {
  // So little motion that a position may jump back to where it began.
  const auto some = [&](int row) {
    Sample sample = at(row);
    sample.q *= 0.3;
    sample.dq *= 0.3;
    return sample;
  };
  const auto twice = [&](int row) { return some(row % 1500); };
  const auto notes = notes_of(robot_, 3000, twice);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("50 percent of the motion stand in the log a second time"),
            std::string::npos)
      << notes[0];
  // A tenth is hardly noticed; more rows than are counted, by a sample of them.
  EXPECT_TRUE(notes_of(robot_, 3000, [&](int row) { return some(row % 2800); }).empty());
  EXPECT_TRUE(some_says(notes_of(robot_, 20000, [&](int row) { return some(row % 15000); }),
                        "25 percent of the motion"));
}

TEST_F(Copies, RestAndNoiseOfItStandAnywhere) {
  const auto resting = [&](int row) {
    Sample sample = at(2001);
    sample.dq.setZero();
    sample.ddq.setZero();
    sample.q[0] += row % 7 == 0 ? 0.001 : 0.0;  // the last bit of a coarse encoder
    if (row > 2000) return at(row);
    return sample;
  };
  EXPECT_TRUE(notes_of(robot_, 3000, resting).empty());
}

}  // namespace
}  // namespace shapeid::test
