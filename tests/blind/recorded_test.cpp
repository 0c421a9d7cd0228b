// A small fixed set from end to end: generated, diagnosed by the command, scored as recorded.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "shapeid/tests/blind/plan.hpp"
#include "shapeid/tests/blind/score.hpp"
#include "shapeid/tests/motion/scratch.hpp"

namespace shapeid::blind {
namespace {

nlohmann::json read_json(const std::string& path) {
  std::ifstream in(path);
  return nlohmann::json::parse(in);
}

/// Large enough that no change of the diagnosis for the better alters the answer.
TEST(Blind, AFixedSetIsScoredAsRecorded) {
  struct Recorded {
    std::string only;
    Outcome outcome;
  };
  const std::vector<Recorded> recorded = {
      {"clean", Outcome::right}, {"cogging", Outcome::right}, {"torque_delay", Outcome::right}};
  const test::Scratch scratch;
  for (const Recorded& r : recorded) {
    SCOPED_TRACE(r.only);
    PlanOptions options;
    options.seed = 31;
    options.trials = 1;
    options.quadruped_every = 0;
    options.only = r.only;
    options.ratio = 8.0;
    const std::string folder = scratch.path(r.only);
    generate(options, folder);
    const std::string trial = folder + "/trial0000/";
    const std::string command = SHAPEID_BUILD_DIR "/shapeid diagnose --robot " + trial +
                                "given.urdf --robot-yaml " + trial + "given.robot.yaml --log " +
                                trial + "log.csv --test " + trial +
                                "test.csv --cutoff 15 --json >" + trial + "result.json";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const Trial sealed = trial_from_json(read_json(trial + "sealed.json"));
    EXPECT_EQ(sealed.items.size(), r.only == "clean" ? 0U : 1U);
    const Judgement judged = judge(sealed, read_json(trial + "result.json"));
    EXPECT_EQ(name_of(judged.outcome), name_of(r.outcome)) << judged.said;
  }
}

}  // namespace
}  // namespace shapeid::blind
