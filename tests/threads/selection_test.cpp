// What `diagnose` does on several threads: hypotheses are compared at once.
#include "shapeid/diagnosis/selection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid::test {
namespace {

using namespace diagnosis;

/// A trot with friction of all drives, a narrow one of one drive, and a spring.
std::vector<Sample> rubbing(const Robot& robot) {
  std::vector<Sample> samples = trot(robot, stacked_parameters(robot), 33, 900, Noise::sensors);
  for (Sample& s : samples) {
    s.tau += 0.2 * s.dq;
    s.tau[4] += 0.8 * std::tanh(s.dq[4] / 0.05);
    s.tau[7] += 0.5 * s.q[7];
  }
  return samples;
}

void expect_same(const Selection& one, const Selection& several) {
  ASSERT_EQ(several.accepted.size(), one.accepted.size());
  for (std::size_t i = 0; i < one.accepted.size(); ++i) {
    EXPECT_EQ(several.accepted[i].candidate, one.accepted[i].candidate);
    EXPECT_EQ(several.accepted[i].t, one.accepted[i].t);
    EXPECT_EQ(several.accepted[i].ambiguous, one.accepted[i].ambiguous);
  }
  ASSERT_EQ(several.last_ranking.size(), one.last_ranking.size());
  for (std::size_t i = 0; i < one.last_ranking.size(); ++i) {
    EXPECT_EQ(several.last_ranking[i].candidate, one.last_ranking[i].candidate);
    EXPECT_EQ(several.last_ranking[i].t, one.last_ranking[i].t);
  }
  EXPECT_EQ(several.usual_is_better, one.usual_is_better);
  EXPECT_EQ(several.hidden, one.hidden);
  EXPECT_EQ(several.error_end, one.error_end);
  EXPECT_EQ(several.fit.value, one.fit.value);
  EXPECT_EQ(several.fit.standard_error, one.fit.standard_error);
}

TEST(Threads, HypothesesComparedAtOnceAreTheSameToTheLastBit) {
  const std::string path = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
  Robot robot = read_urdf(path + "urdf").robot;
  static_cast<void>(read_robot_yaml(path + "robot.yaml", robot));
  const RichModel model{stacked_parameters(robot), {}};
  const Recording log(rubbing(robot), 500.0);
  TallyOptions options;
  options.stride = 3;
  options.block_seconds = 0.15;
  options.margin = 0.02;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  std::vector<AppliedEffect> hypotheses;
  for (const AppliedEffect& h : all_hypotheses(robot)) {
    if (!h.effect->transform.any()) hypotheses.push_back(h);
  }
  Tally tally = empty_tally(robot, hypotheses);
  add_to_tally(tally, robot, {ContactTreatment::project, Path::fast}, model, log, options, false);
  const BlockFits fits(std::move(tally), model.Phi,
                       Eigen::VectorXd::Constant(model.Phi.size(), 0.1), 6);
  const Term masses = term_of_masses({0});
  CandidateRule of;
  of.free_links = {0};
  of.excluded = [](const AppliedEffect&) { return false; };
  of.choices = [](const AppliedEffect&) { return 1.0; };
  const std::vector<Candidate> list = candidates(robot, fits, of);
  const auto selected = [&](std::size_t threads) {
    SelectionRule rule;
    rule.threads = threads;
    return select(fits, masses, list, rule);
  };
  // The first in parallel, so that sums are made by several threads.
  const Selection several = selected(3);
  EXPECT_GE(several.accepted.size(), 2U);
  const Selection one = selected(1);
  expect_same(one, several);
  expect_same(one, selected(2));
}

}  // namespace
}  // namespace shapeid::test
