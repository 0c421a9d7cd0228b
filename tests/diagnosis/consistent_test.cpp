// Bodies that can exist in place of free numbers, and how well the data know them.
#include "shapeid/diagnosis/consistent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/refit.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/models/shape.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::record;

TEST(Consistent, LinksAreBodiesAndTheEffectIsStillThere) {
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}});
  const LoopSettings settings = arm_settings();
  const LoopResult loop = close_loop(arm(), log, nullptr, settings);
  const Consistent result = make_consistent(arm(), log, nullptr, settings, loop);
  ASSERT_EQ(result.model.effects.size(), 1U);
  constexpr double errors = 5.0;
  EXPECT_LT(std::abs(result.model.effects[0].value[0] - 0.3), errors * result.effect_error[0][0]);
  for (int link = 1; link < 4; ++link) {
    const InertialParameters body{result.model.Phi.segment<10>(Eigen::Index{10} * link)};
    EXPECT_FALSE(why_impossible(body)) << link;
  }
}

/// What was found is given: asked is what bodies and errors make of it.
struct Told {
  LoopResult loop;
  Consistent model;

  Told(const Recording& log, const Recording& reference, const AppliedEffect& effect) {
    const LoopSettings settings = arm_settings();
    loop.weight = Eigen::VectorXd::Ones(3);
    loop.prior = 1e-6;
    loop.hypotheses = 150;
    loop.model = {stacked_parameters(arm()), {effect}};
    loop.found = {{effect, "told", Eigen::VectorXd::Zero(effect.value.size())}};
    model = make_consistent(arm(), log, &reference, settings, loop);
    mark_faded(log, settings, model, loop);
  }
};

/// The first link turns about the vertical: no row feels its mass, and none outweighs the given
/// one, however exact the log is.
TEST(Consistent, AMassThatNoRowFeelsStaysAsGivenWithoutNoise) {
  const Robot robot = arm();
  const LoopSettings settings = arm_settings();
  for (const double sigma : {0.0, 1e-5, 0.02}) {
    const Recording log = record({{}, 20.0, sigma});
    const LoopResult loop = close_loop(robot, log, nullptr, settings);
    const Consistent consistent = make_consistent(robot, log, nullptr, settings, loop);
    ASSERT_FALSE(consistent.data.determined[0]) << sigma;
    const double given = robot.links[1].inertia.mass();
    EXPECT_NEAR(consistent.model.Phi[10], given, 0.03 * given) << sigma;
  }
}

/// A tenth of both logs together would be all of the short one.
TEST(Consistent, WhatCameSinceALongReferenceIsCertain) {
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}, 20.0, 0.02, 2});
  AppliedEffect friction = effect("viscous_friction", 1, {0.3});
  friction.when = When::since_reference;
  const Told told(log, record({{}, 200.0}), friction);
  ASSERT_EQ(told.model.model.effects.size(), 1U);
  EXPECT_NEAR(told.model.model.effects[0].value[0], 0.3, 0.01);
  EXPECT_LT(told.model.effect_error[0][0], 0.01);
  EXPECT_FALSE(told.loop.found[0].faded);
}

/// What a transformation's number takes from the masses, and they from it, is as uncertain as it
/// is. With an encoder's offset held as it was found, a first moment was eight of its errors off.
TEST(Consistent, ErrorsAllowForThoseOfTransformations) {
  const Robot robot = arm();
  const LoopSettings settings = arm_settings();
  const Eigen::VectorXd truth = stacked_parameters(robot);
  constexpr int seeds = 10;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(30);
  std::vector<bool> always(30, true);
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    const Recording log = record({{}, 20.0, 0.02, seed});
    LoopState state(robot, log, nullptr, settings);
    state.fit_masses();
    state.reweigh();
    state.result.found = {{effect("encoder_offset", 1, {0.0}), "told", Eigen::VectorXd::Zero(1)}};
    state.collect_effects();
    refit(state);
    const Consistent fitted = make_consistent(robot, log, nullptr, settings, state.result);
    for (std::size_t p = 0; p < 30; ++p) {
      const auto at = static_cast<Eigen::Index>(p);
      always[p] = always[p] && fitted.data.determined[p];
      squares[at] +=
          std::pow((fitted.model.Phi[10 + at] - truth[10 + at]) / fitted.Phi_error[10 + at], 2);
    }
  }
  EXPECT_GT(std::ranges::count(always, true), 3);
  for (std::size_t p = 0; p < 30; ++p) {
    if (!always[p]) continue;
    EXPECT_LT(std::sqrt(squares[static_cast<Eigen::Index>(p)] / seeds), 2.0) << p;
  }
}

/// The reference has its own clock: at the same time nothing came there.
TEST(Consistent, ALoadThatCameIsNotInTheReference) {
  AppliedEffect load =
      effect("payload_from", 3, {0.8, 0.02, 0.0, 0.2, 0.06, 0.0, -0.004, 0.06, 0.0, 0.002});
  load.shape[0] = 9.0;
  const Told told(record({{load}, 20.0, 0.02, 2}), record({{}, 20.0}), load);
  ASSERT_EQ(told.model.model.effects.size(), 1U);
  EXPECT_NEAR(told.model.model.effects[0].value[0], 0.8, 0.02);
  const double given = stacked_parameters(arm())[30];
  EXPECT_NEAR(told.model.model.Phi[30], given, 0.1 * given);
}

/// The load as it was carried is none that can be: its inertia is that of nothing half a metre from
/// its own centre. The ten numbers alone would repeat it.
TEST(Consistent, ALoadIsABody) {
  AppliedEffect load =
      effect("payload_from", 3, {0.8, 0.02, 0.0, 0.4, -0.06, 0.0, 0.004, -0.06, 0.0, -0.002});
  load.shape[0] = 9.0;
  const Told told(record({{load}, 20.0, 0.02, 2}), record({{}, 20.0}), load);
  ASSERT_EQ(told.model.model.effects.size(), 1U);
  EXPECT_TRUE(why_impossible(InertialParameters{load.value}));
  const Eigen::VectorXd& body = told.model.model.effects[0].value;
  EXPECT_FALSE(why_impossible(InertialParameters{body}));
  EXPECT_NEAR(body[0], 0.8, 0.2);
}

/// The first link turns about one axis: of a load there its moment of inertia about that is all
/// that shows. It is certain, and what no data show is not called known.
TEST(Consistent, OfALoadOnlyWhatShowsIsDetermined) {
  AppliedEffect load = effect("payload_from", 1, {0.0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  load.value = 0.5 * unit_parameters(make_point({0.4, 0.3, 0.1}, 1.0)).values;
  load.shape[0] = 9.0;
  const Told told(record({{load}, 20.0, 0.02, 2}), record({{}, 20.0}), load);
  ASSERT_EQ(told.model.model.effects.size(), 1U);
  const Eigen::VectorXd& error = told.model.effect_error[0];
  EXPECT_GT(error[0], 1.0);
  EXPECT_GT(error[1], 1.0);
  EXPECT_LT(error[9], 0.02 * load.value[9]);
  EXPECT_NEAR(told.model.model.effects[0].value[9], load.value[9], 0.02 * load.value[9]);
  EXPECT_LT(told.model.load_size_error[0], 0.02);
  EXPECT_FALSE(told.loop.found[0].faded);
}

/// What was taken away is no load. Free links take most of it, and a body on the other side some.
TEST(Consistent, WhatWasTakenAwayIsNoLoad) {
  AppliedEffect less =
      effect("payload_from", 3, {-0.3, 0.0, 0.0, -0.05, -0.01, 0.0, 0.0, -0.01, 0.0, -0.001});
  less.shape[0] = 9.0;
  const Told told(record({{less}, 20.0, 0.02, 2}), record({{}, 20.0}), less);
  EXPECT_TRUE(told.loop.found[0].faded || !told.model.dropped.empty());
}

/// Every link is trusted: a load is all that has a mass.
Consistent of_load_alone(const AppliedEffect& load) {
  LoopSettings settings = arm_settings();
  settings.shapes = {stacked_parameters(arm()), {}, {}};
  settings.expected_mass = 0.0;
  LoopResult loop;
  loop.weight = Eigen::VectorXd::Ones(3);
  loop.model = {stacked_parameters(arm()), {load}};
  loop.found = {{load, "told", Eigen::VectorXd::Zero(10)}};
  return make_consistent(arm(), record({{load}}), nullptr, settings, loop);
}

/// On a link that turns about one axis a negative inertia has no other side.
TEST(Consistent, ALoadWithoutMassIsLeftOut) {
  const Consistent result = of_load_alone(
      effect("payload", 1, {-0.3, 0.0, 0.0, 0.0, -0.05, 0.0, 0.0, -0.05, 0.0, -0.05}));
  EXPECT_TRUE(result.model.effects.empty());
  ASSERT_EQ(result.dropped.size(), 1U);
  EXPECT_EQ(result.dropped[0].effect->id, "payload");
}

TEST(Consistent, ALoadOfTrustedLinksComesBack) {
  const Consistent result =
      of_load_alone(effect("payload", 3, {0.8, 0.0, 0.0, 0.2, 0.06, 0.0, 0.0, 0.06, 0.0, 0.002}));
  EXPECT_EQ(result.model.Phi, stacked_parameters(arm()));
  ASSERT_EQ(result.model.effects.size(), 1U);
  EXPECT_NEAR(result.model.effects[0].value[0], 0.8, 0.001);
  EXPECT_NEAR(result.model.effects[0].value[3], 0.2, 0.001);
}

/// With two links known the third comes back as it is (a wrong column of known forces once gave it
/// the mass of all three).
TEST(Consistent, KnownLinksAreMovedOver) {
  const Recording log = record({});
  LoopSettings settings = arm_settings();
  settings.shapes = generous_regions(arm(), {3});
  settings.expected_mass = 1.0;
  settings.rounds = 1;
  const LoopResult loop = close_loop(arm(), log, nullptr, settings);
  const Consistent result = make_consistent(arm(), log, nullptr, settings, loop);
  const Eigen::VectorXd given = stacked_parameters(arm());
  EXPECT_EQ(result.model.Phi.head(30), given.head(30));
  EXPECT_LT(std::abs(result.model.Phi[30] - given[30]), 0.1 * given[30]);
}

}  // namespace
}  // namespace shapeid::diagnosis
