// Of rounds that do not settle the best is kept, wherever it stands among them.
#include "shapeid/diagnosis/best_round.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using Ids = std::vector<std::string>;

const double friction = 0.3;  // N m s/rad, of joint2 in the log

class BestRound : public ::testing::Test {
 protected:
  /// A round that found the effect and has weights, correction and times of its own.
  [[nodiscard]] LoopResult round_with(const AppliedEffect& effect, double weight,
                                      double correction_per_speed, double seconds) const {
    LoopResult round = state_.result;
    round.found = {Found{effect, effect.effect->id, Eigen::VectorXd::Zero(1)}};
    round.model.effects = {effect};
    round.weight = Eigen::VectorXd::Constant(3, weight);
    for (const Sample& s : log_.samples()) {
      round.correction.emplace_back(Eigen::Vector3d(0.0, correction_per_speed * s.dq[1], 0.0));
    }
    round.screening_seconds = seconds;
    round.refit_seconds = 2.0 * seconds;
    return round;
  }

  const Robot robot_ = test::arm();
  const Recording log_ = test::record({{test::effect("viscous_friction", 1, {friction})}});
  const LoopSettings settings_ = test::arm_settings();
  LoopState state_{robot_, log_, nullptr, settings_};
  const LoopResult right_ =
      round_with(test::effect("viscous_friction", 1, {friction}), 30.0, 0.0, 1.0);
  const LoopResult close_ =
      round_with(test::effect("coulomb_friction", 1, {friction}), 20.0, 0.0, 2.0);
  const LoopResult wrong_ =
      round_with(test::effect("viscous_friction", 2, {friction}), 10.0, 0.0, 3.0);

  std::size_t taken_ = 0;

  /// What is kept of the rounds, after the last of them.
  void keep_of(const std::vector<LoopResult>& rounds) {
    state_.result = rounds.back();
    state_.use_correction(rounds.back().correction);
    taken_ = take_best_of(rounds, state_);
  }
};

TEST_F(BestRound, IsKeptWhereverItStands) {
  std::vector<LoopResult> rounds = {right_, close_, wrong_};
  for (int turn = 0; turn < 3; ++turn) {
    keep_of(rounds);
    ASSERT_EQ(test::found_ids(state_.result), Ids{"viscous_friction"}) << turn;
    EXPECT_EQ(taken_, static_cast<std::size_t>((3 - turn) % 3)) << turn;
    EXPECT_EQ(state_.result.found[0].effect.site, 1) << turn;
    EXPECT_EQ(state_.result.model.effects[0].site, 1) << turn;
    EXPECT_EQ(state_.result.weight, right_.weight) << turn;
    EXPECT_EQ(state_.result.screening_seconds, rounds.back().screening_seconds) << turn;
    EXPECT_EQ(state_.result.refit_seconds, rounds.back().refit_seconds) << turn;
    std::rotate(rounds.begin(), rounds.begin() + 1, rounds.end());
  }
  keep_of({wrong_});
  EXPECT_EQ(state_.result.found[0].effect.site, 2) << "the only one";
}

/// By its own measure a round could leave next to nothing: with small weights, or with a correction
/// that takes away what it did not find.
TEST_F(BestRound, IsJudgedByTheLastOnesMeasure) {
  LoopResult light = wrong_, corrected = wrong_;
  light.weight *= 1e-9;
  for (std::size_t i = 0; i < log_.samples().size(); ++i) {
    corrected.correction[i] = Eigen::Vector3d(0.0, -friction * log_[i].dq[1], 0.0);
  }
  LoopResult right = right_;
  right.correction.assign(log_.samples().size(), Eigen::Vector3d(0.0, 0.0, 1e-6));
  keep_of({light, corrected, right, close_});
  EXPECT_EQ(state_.result.found[0].effect.site, 1);
  EXPECT_EQ(test::found_ids(state_.result), Ids{"viscous_friction"});
  EXPECT_EQ(state_.log.correction(0), right.correction[0]) << "goes on with what it was found with";
}

}  // namespace
}  // namespace shapeid::diagnosis
