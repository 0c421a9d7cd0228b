// Noise of differentiated positions: known by its spectrum, and not taken for a cause.
#include "shapeid/diagnosis/motion_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/consistent.hpp"
#include "shapeid/diagnosis/unnoticed.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/segment_filter.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::before_a_gear;
using test::loop_of;
using test::record;

constexpr double filter_cutoff = 15.0, rate = 100.0;  // Hz
const std::vector<double> all_noise = {0.9, 0.9, 0.9}, none = {0.5, 0.5, 0.5};

/// What a log's filter leaves.
Eigen::VectorXd filtered(const Eigen::VectorXd& x) {
  SegmentFilter filter(Smoothing::zero_phase, Butterworth(log_filter_order, filter_cutoff, rate),
                       1);
  for (const double value : x) filter.push(Eigen::VectorXd::Constant(1, value));
  filter.finish();
  Eigen::VectorXd smooth(x.size());
  for (double& value : smooth) value = (*filter.next())[0];
  return smooth;
}

Eigen::VectorXd white(Eigen::Index count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise;
  Eigen::VectorXd x(count);
  for (double& value : x) value = noise(generator);
  return x;
}

Eigen::VectorXd second_difference(const Eigen::VectorXd& x) {
  Eigen::VectorXd d = Eigen::VectorXd::Zero(x.size());
  const Eigen::Index n = x.size() - 2;
  d.segment(1, n) = x.head(n) - 2.0 * x.segment(1, n) + x.tail(n);
  return d;
}

/// Joint 1 has noise of torque, joint 2 that of a position, twice differentiated, joint 3 as much
/// of that beside something slow.
TEST(NoiseOfMotion, IsFasterThanNoiseOfTorque) {
  const Recording log = record({{}, 20.0, 0.02, 3});
  const auto count = static_cast<Eigen::Index>(log.samples().size());
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    Series series;
    series.residual.resize(3, count);
    series.counted.setConstant(3, count, true);
    for (std::size_t i = 0; i < log.samples().size(); ++i) series.index.push_back(i);
    const Eigen::VectorXd torque = filtered(white(count, seed));
    const Eigen::VectorXd motion = filtered(second_difference(white(count, 100 + seed)));
    const Eigen::VectorXd slow = Eigen::VectorXd::LinSpaced(count, 0.0, 30.0).array().sin();
    series.residual << torque.transpose(), motion.transpose(),
        (motion / motion.norm() + slow / slow.norm()).transpose();
    series.predicted = series.residual;
    const std::vector<double> shares = fast_shares(arm(), log, series, filter_cutoff);
    ASSERT_EQ(shares.size(), 3U);
    EXPECT_FALSE(is_noise_of_motion(shares[0])) << shares[0];
    EXPECT_TRUE(is_noise_of_motion(shares[1])) << shares[1];
    EXPECT_FALSE(is_noise_of_motion(shares[2])) << shares[2];
    EXPECT_NEAR(shares[0], 0.42, 0.1);
    EXPECT_NEAR(shares[1], 0.97, 0.03);  // a difference is less than the square of frequency
    EXPECT_NEAR(shares[2], 0.49, 0.05);
    // Of what is predicted the noise is a part; torque that changes as fast is no noise.
    series.predicted.row(1) += 50.0 * slow.transpose();
    EXPECT_EQ(fast_shares(arm(), log, series, filter_cutoff), shares);
    series.predicted.row(1) +=
        Eigen::VectorXd::LinSpaced(count, 0.0, 1500.0).array().sin().matrix().transpose();
    EXPECT_EQ(fast_shares(arm(), log, series, filter_cutoff)[1], 0.0);
  }
}

/// A motion that is slow and far larger than the noise, of which stretches are held out: at gaps it
/// seems fast.
TEST(NoiseOfMotion, IsKnownBetweenStretchesThatAreHeldOut) {
  const Recording log = record({{}, 20.0, 0.02, 3});
  Series series;
  for (std::size_t i = 0; i < log.samples().size(); ++i) {
    constexpr double stretch = 2.0;  // s, of which every fifth is left out
    if (static_cast<int>(log[i].time / stretch) % 5 != 2) series.index.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(series.index.size());
  ASSERT_LT(series.index.size(), log.samples().size());
  const Eigen::VectorXd motion = filtered(second_difference(white(count, 21)));
  Eigen::VectorXd slow(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    slow[i] = std::sin(0.7 + 2.0 * log[series.index[static_cast<std::size_t>(i)]].time);
  }
  series.counted.setConstant(3, count, true);
  series.residual = motion.transpose().replicate(3, 1);
  series.predicted = series.residual;
  series.predicted.row(1) += 1e3 * slow.transpose();
  const std::vector<double> shares = fast_shares(arm(), log, series, filter_cutoff);
  EXPECT_TRUE(is_noise_of_motion(shares[0]));
  EXPECT_EQ(shares[1], shares[0]);
}

TEST(NoiseOfMotion, OfALogThatIsTooShortNothingIsSaid) {
  const Recording log = record({{}, 20.0, 0.02, 3});
  for (const double share : fast_shares(arm(), log, {}, filter_cutoff)) EXPECT_EQ(share, 0.0);
}

Recording with_a_gear() {
  return before_a_gear([](double torque) { return 0.0005 * torque; });
}

std::vector<Stranger> taken_back(const Recording& smoother, const std::vector<double>& shares,
                                 LoopResult& loop) {
  const LoopSettings settings = test::arm_settings();
  return take_back_noise(arm(), {smoother, nullptr, settings}, shares, loop);
}

TEST(NoiseOfMotion, ALawThatTheSmootherLogLacksIsTakenBack) {
  LoopResult loop = loop_of(with_a_gear());
  ASSERT_EQ(loop.strangers.size(), 1U);
  LoopResult same = loop;
  EXPECT_TRUE(taken_back(record({}), none, same).empty());
  EXPECT_EQ(same.strangers.size(), 1U);
  const std::vector<Stranger> gone = taken_back(record({}), all_noise, loop);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(law_text(gone[0], arm()), "gear@joint2 that yields");
  EXPECT_TRUE(loop.strangers.empty());
}

TEST(NoiseOfMotion, ALawThatTheSmootherLogHasStays) {
  LoopResult loop = loop_of(with_a_gear());
  EXPECT_TRUE(taken_back(with_a_gear(), all_noise, loop).empty());
  EXPECT_EQ(loop.strangers.size(), 1U);
}

TEST(NoiseOfMotion, OfTooShortALogNothingIsAsked) {
  LoopResult loop = loop_of(with_a_gear());
  EXPECT_THROW(std::ignore = taken_back(record({{}, 3.0}), all_noise, loop), Refusal);
  EXPECT_EQ(loop.strangers.size(), 1U);
}

/// A name that such a law had displaced stands again, as the smoother log has it.
TEST(NoiseOfMotion, NamesAreQuestionedAnew) {
  const Recording log = record({{test::effect("torque_offset", 1, {0.3})}});
  LoopResult loop = loop_of(log);
  ASSERT_EQ(loop.found.size(), 1U);
  loop.strangers = loop_of(with_a_gear()).strangers;
  loop.found[0].displaced = true;
  EXPECT_EQ(taken_back(log, all_noise, loop).size(), 1U);
  EXPECT_TRUE(loop.found[0].name_stands());
}

/// Two causes, of which the smoother log has one: the other goes out of the model with its name,
/// and what is said of the one is said without it.
TEST(NoiseOfMotion, WhatTheSmootherLogLacksIsNoCause) {
  const AppliedEffect offset = test::effect("torque_offset", 1, {0.3});
  const AppliedEffect friction = test::effect("viscous_friction", 2, {0.4});
  const Recording log = record({{offset, friction}}), smoother = record({{friction}});
  const LoopSettings settings = test::arm_settings();
  const auto take_back = [&](const Recording& behind, LoopResult& loop) {
    return take_back_names(arm(), {log, nullptr, settings}, {behind, nullptr, settings}, loop);
  };
  LoopResult loop = loop_of(log);
  ASSERT_EQ(loop.found.size(), 2U);
  LoopResult same = loop;
  EXPECT_TRUE(take_back(log, same).empty());
  EXPECT_EQ(same.found.size(), 2U);
  EXPECT_EQ(same.error_end, loop.error_end);

  EXPECT_THROW(std::ignore = take_back(record({{friction}, 3.0}), same), Refusal);
  EXPECT_EQ(same.found.size(), 2U);

  const LoopResult before = loop;
  const std::vector<Found> gone = take_back(smoother, loop);
  ASSERT_EQ(gone.size(), 1U);
  EXPECT_EQ(gone[0].id, "torque_offset@joint2");
  ASSERT_EQ(loop.found.size(), 1U);
  ASSERT_EQ(loop.model.effects.size(), 1U);
  EXPECT_EQ(loop.found[0].id, "viscous_friction@joint3");
  EXPECT_NEAR(loop.found[0].effect.value[0], 0.4, 0.1);
  EXPECT_GT(loop.error_end, 2.0 * before.error_end);  // the offset is not explained any more
  const auto gain_before = std::ranges::find(before.found, loop.found[0].id, &Found::id)->gain;
  EXPECT_LT(loop.found[0].gain, gain_before);
  EXPECT_GT(loop.found[0].gain, 0.0);
}

/// The same two where nothing is most of what remains: both stay in the model, and one name falls.
TEST(NoiseOfMotion, ANameThatTheSmootherLogLacksFalls) {
  const AppliedEffect offset = test::effect("torque_offset", 1, {0.3});
  const AppliedEffect friction = test::effect("viscous_friction", 2, {0.4});
  const Recording log = record({{offset, friction}}), smoother = record({{friction}});
  const LoopSettings settings = test::arm_settings();
  const auto standing = [&](const Recording& behind) {
    LoopResult loop = loop_of(log);
    doubt_names(arm(), {log, nullptr, settings}, {behind, nullptr, settings}, loop);
    EXPECT_EQ(loop.found.size(), 2U);
    std::vector<std::string> names;
    for (const Found& f : loop.found) {
      if (f.name_stands()) names.push_back(f.id);
    }
    return names;
  };
  EXPECT_EQ(standing(log).size(), 2U);
  EXPECT_EQ(standing(smoother), std::vector<std::string>{"viscous_friction@joint3"});
}

/// A ripple of so many periods a radian that the smoother log has lost it is no noise for that; one
/// that a smoother log would still have is.
TEST(NoiseOfMotion, ARippleThatTheSlowerFilterTakesAwayStands) {
  for (const double periods : {40.0, 4.0}) {
    AppliedEffect ripple = test::effect("cogging", 1, {0.2, 0.1});
    ripple.shape[0] = periods;
    const Recording log = record({{ripple}}), smoother = record({});
    LoopSettings settings = test::arm_settings(), slower = settings;
    slower.cutoff = 2.0;
    LoopResult loop = loop_of(log);
    ASSERT_EQ(loop.found.size(), 1U) << periods;
    const bool is_fast = is_fast_ripple(log, loop.found[0].effect, slower.cutoff);
    EXPECT_EQ(is_fast, periods > 10.0);
    const auto gone =
        take_back_names(arm(), {log, nullptr, settings}, {smoother, nullptr, slower}, loop);
    EXPECT_EQ(gone.empty(), is_fast);
  }
}

/// Numbers are fitted anew: what noise has made of the masses is no structure of a log that has
/// less of it.
TEST(NoiseOfMotion, CurvesAreAskedBesideRefittedNumbers) {
  const Recording log = record({{test::effect("torque_offset", 1, {0.3})}});
  const auto structures = [](const Recording& of, const LoopResult& loop) {
    const LoopSettings settings = test::arm_settings();
    return unexplained_behind(arm(), {of, nullptr, settings}, loop);
  };
  LoopResult loop = loop_of(log);
  loop.model.Phi.tail(30) *= 0.9;
  loop.found[0].effect.value[0] = loop.model.effects[0].value[0] = 0.2;
  EXPECT_TRUE(structures(log, loop).empty());
  const Recording warped = record({{}}, [](std::vector<Sample>& samples) {
    for (Sample& s : samples) s.tau[1] += 0.3 + 0.1 * std::sin(3.0 * s.q[1]);
  });
  const auto found = structures(warped, loop);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].joint, "joint2");
}

/// The arm's log with noise of its accelerations, of so many rad/s^2.
Recording shaken(double size) {
  return record({{}, 20.0, 0.02, 3}, [size](std::vector<Sample>& samples) {
    std::mt19937 generator(7);
    std::normal_distribution<double> noise;
    for (Sample& s : samples) {
      for (double& ddq : s.ddq) ddq += size * noise(generator);
    }
  });
}

/// It makes inertias too small, and a log with less of it says by how much: what a number moves by
/// goes towards the truth, for all that the noise has moved by more than its error.
TEST(NoiseOfMotion, WhatItDoesToInertiasShowsBehindTheSlowerFilter) {
  const LoopSettings settings = test::arm_settings();
  const Recording log = shaken(1.0), smoother = shaken(0.1);
  const LoopResult loop = loop_of(log);
  const Eigen::VectorXd moves = moves_behind(arm(), {smoother, nullptr, settings}, loop);
  const Eigen::VectorXd of_itself = moves_behind(arm(), {log, nullptr, settings}, loop);
  const Eigen::VectorXd off = loop.model.Phi - stacked_parameters(arm());
  const Consistent model = make_consistent(arm(), log, nullptr, settings, loop);
  int biased = 0;
  for (Eigen::Index p = 10; p < off.size(); ++p) {
    constexpr double surely = 6.0;
    if (!model.data.determined[static_cast<std::size_t>(p - 10)]) continue;
    EXPECT_LT(std::abs(of_itself[p]), model.Phi_error[p]) << "the same log moves nothing";
    if (!(std::abs(off[p]) > surely * model.Phi_error[p])) continue;
    ++biased;
    EXPECT_NEAR(moves[p] / -off[p], 1.0, 0.3) << p;
  }
  EXPECT_GT(biased, 1);
  EXPECT_EQ(moves.head(10), Eigen::VectorXd::Zero(10)) << "of a link that is not sought";
}

/// Beside what an effect may have done; nothing of links that are not sought.
TEST(NoiseOfMotion, IsInTheErrorOfWhatIsSought) {
  Unnoticed unnoticed{Eigen::VectorXd::Constant(30, 3.0), std::vector<std::string>(30)};
  allow_for_filter(Eigen::VectorXd::Constant(30, -4.0), {1}, unnoticed);
  EXPECT_EQ(unnoticed.error.head(10), Eigen::VectorXd::Constant(10, 3.0));
  EXPECT_EQ(unnoticed.error.segment(10, 10), Eigen::VectorXd::Constant(10, 5.0));
  EXPECT_EQ(unnoticed.error.tail(10), Eigen::VectorXd::Constant(10, 3.0));
}

}  // namespace
}  // namespace shapeid::diagnosis
