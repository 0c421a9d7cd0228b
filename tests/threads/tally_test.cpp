// What `diagnose` does on several threads: blocks of a log are summed at once.
#include "shapeid/diagnosis/tally.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::test {
namespace {

using namespace diagnosis;

/// Every hypothesis, those that are differences of transformed robots among them, on both paths.
TEST(Threads, BlocksSummedAtOnceAreTheSameToTheLastBit) {
  const std::string path = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
  Robot robot = read_urdf(path + "urdf").robot;
  static_cast<void>(read_robot_yaml(path + "robot.yaml", robot));
  const RichModel model{stacked_parameters(robot), {}};
  const Recording log(trot(robot, model.Phi, 31, 900, Noise::sensors), 500.0);
  TallyOptions options;
  options.stride = 7;
  options.block_seconds = 0.2;
  options.margin = 0.02;
  options.log_starts = {430};
  options.weight = Eigen::VectorXd::LinSpaced(robot.dof(), 0.5, 2.0);
  for (const Path by : {Path::reference, Path::fast}) {
    const auto summed = [&](std::size_t threads) {
      options.threads = threads;
      Tally tally = empty_tally(robot, all_hypotheses(robot));
      add_to_tally(tally, robot, {ContactTreatment::project, by}, model, log, options, false);
      return tally.blocks;
    };
    const std::vector<Block> one = summed(1);
    ASSERT_GE(one.size(), 8U);
    EXPECT_EQ(one.front().log, 0U);
    EXPECT_EQ(one.back().log, 1U);
    for (const std::size_t threads : {2U, 3U, 100U}) {
      const std::vector<Block> several = summed(threads);
      ASSERT_EQ(several.size(), one.size());
      for (std::size_t b = 0; b < one.size(); ++b) {
        EXPECT_TRUE(one[b].sums.allFinite());
        EXPECT_EQ(several[b].sums, one[b].sums) << b;
        EXPECT_EQ(several[b].samples, one[b].samples);
        EXPECT_EQ(several[b].from, one[b].from);
        EXPECT_EQ(several[b].log, one[b].log);
        EXPECT_EQ(several[b].freedom, one[b].freedom);
      }
    }
  }
}

}  // namespace
}  // namespace shapeid::test
