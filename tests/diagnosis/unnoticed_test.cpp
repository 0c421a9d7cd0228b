// Errors that do not take for granted that nothing acts but what was found.
#include "shapeid/diagnosis/unnoticed.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::record;

/// One link sought; what was found, if anything, is given.
struct Fitted {
  LoopSettings settings = arm_settings();
  LoopResult loop;
  Consistent model;
  Unnoticed unnoticed;

  Fitted(const Recording& log, int link, const std::vector<AppliedEffect>& found = {},
         const Robot& robot = arm()) {
    settings.shapes = generous_regions(robot, {link});
    settings.expected_mass = 2.0;
    loop.weight = Eigen::VectorXd::Ones(3);
    loop.prior = 1e-6;
    loop.model = {stacked_parameters(robot), found};
    for (const AppliedEffect& a : found) {
      loop.found.push_back({a, "found", Eigen::VectorXd::Zero(a.value.size())});
    }
    model = make_consistent(robot, log, nullptr, settings, loop);
    unnoticed = diagnosis::unnoticed(robot, log, nullptr, settings, loop, model);
  }

  [[nodiscard]] double wrong(Eigen::Index number) const {
    return std::abs(model.model.Phi[number] - stacked_parameters(arm())[number]);
  }
  [[nodiscard]] const std::string& effect_at(Eigen::Index number) const {
    return unnoticed.effect[static_cast<std::size_t>(number)];
  }
};

constexpr Eigen::Index Iyy = 7, Izz = 9;

/// Joint 1 stands upright: of its link nothing but Izz is seen, and in nothing but the rotor's
/// column. The data say nothing of what is the rotor's: it may be all that the link could have.
TEST(Unnoticed, WhatCannotBeToldAtAllMayBeAllThatTheLinkCouldHave) {
  const Fitted fitted(record({}), 1);
  EXPECT_EQ(fitted.effect_at(10 + Izz), "rotor_inertia@joint1");
  const double expected =
      std::hypot(fitted.model.Phi_error[10 + Izz], fitted.settings.size[10 + Izz]);
  EXPECT_NEAR(fitted.unnoticed.error[10 + Izz] / expected, 1.0, 1e-6);  // the fits' regularity
}

/// A rotor becomes inertia of the link, with a standard error that says nothing of it.
TEST(Unnoticed, CoversARotorThatTheLinkHasTaken) {
  const Fitted fitted(record({{effect("rotor_inertia", 0, {0.005})}}), 1);
  constexpr double errors = 3.0;
  EXPECT_GT(fitted.wrong(10 + Izz), errors * fitted.model.Phi_error[10 + Izz]);
  EXPECT_LT(fitted.wrong(10 + Izz), fitted.unnoticed.error[10 + Izz]);
}

/// Every effect that an arm can have, at each of its places, half as large as one usually sees:
/// where the numbers that the data determine have taken it, what is said beside the standard error
/// holds the mistake. The standard error alone does not.
TEST(Unnoticed, CoversEveryEffectOfTheCatalogue) {
  const Robot robot = arm();
  constexpr double errors = 3.0;
  int beyond_standard_errors = 0;
  for (AppliedEffect a : all_hypotheses(robot)) {
    for (Eigen::Index p = 0; p < a.value.size(); ++p) {
      a.value[p] = 0.5 * a.effect->parameters[static_cast<std::size_t>(p)].size;
    }
    const int link = a.effect->site == SiteKind::joint ? a.site + 1 : 3;
    const Fitted fitted(record({{a}}), link);
    bool beyond = false;
    for (Eigen::Index p = 0; p < 10; ++p) {
      if (!fitted.model.data.determined[static_cast<std::size_t>(p)]) continue;
      const Eigen::Index number = Eigen::Index{10} * link + p;
      EXPECT_LT(fitted.wrong(number), errors * fitted.unnoticed.error[number])
          << hypothesis_id(robot, a) << ", number " << p;
      beyond = beyond || fitted.wrong(number) > 5.0 * fitted.model.Phi_error[number];
    }
    if (beyond) ++beyond_standard_errors;
  }
  EXPECT_GE(beyond_standard_errors, 10);
}

TEST(Unnoticed, WhatWasFoundIsNotUnnoticed) {
  const std::vector<AppliedEffect> truth = {effect("rotor_inertia", 2, {0.003})};
  const Recording log = record({truth, 20.0, 0.2});
  const Fitted untold(log, 3), told(log, 3, truth);
  EXPECT_EQ(untold.effect_at(30 + Iyy), "rotor_inertia@joint3");
  EXPECT_NE(told.effect_at(30 + Iyy), "rotor_inertia@joint3");
  EXPECT_GT(told.model.Phi_error[30 + Iyy], 1.2 * untold.model.Phi_error[30 + Iyy])
      << "what the rotor makes uncertain is in the standard error then";
  // Told and untold, what the link has taken is its move per unit times the rotor's inertia.
  const double rotor = told.model.model.effects[0].value[0], s = told.model.effect_error[0][0];
  const double moved = untold.model.model.Phi[30 + Iyy] - told.model.model.Phi[30 + Iyy];
  const double added = std::abs(moved / rotor) * std::hypot(rotor, s);
  const double said = std::sqrt(std::pow(untold.unnoticed.error[30 + Iyy], 2) -
                                std::pow(untold.model.Phi_error[30 + Iyy], 2));
  EXPECT_GT(said / added, 0.6) << "one error is by leaving out tenths, the other by blocks";
  EXPECT_LT(said / added, 1.6);
}

/// The same where the rotor's standard error is a small part of it: not the error, the rotor
/// itself.
TEST(Unnoticed, HasAllThatALinkTookOfARotorThatIsSeenWell) {
  const std::vector<AppliedEffect> truth = {effect("rotor_inertia", 2, {0.003})};
  const Recording log = record({truth, 20.0, 0.02});
  const Fitted untold(log, 3), told(log, 3, truth);
  const double rotor = told.model.model.effects[0].value[0];
  ASSERT_GT(rotor, 3.0 * told.model.effect_error[0][0]);
  const double moved = untold.model.model.Phi[30 + Iyy] - told.model.model.Phi[30 + Iyy];
  const double said = std::sqrt(std::pow(untold.unnoticed.error[30 + Iyy], 2) -
                                std::pow(untold.model.Phi_error[30 + Iyy], 2));
  EXPECT_NEAR(said / std::abs(moved), 1.0, 0.3);
}

/// And where noise hides it, its standard error.
TEST(Unnoticed, HasTheErrorOfARotorThatIsNotSeen) {
  const std::vector<AppliedEffect> truth = {effect("rotor_inertia", 2, {0.003})};
  const Recording log = record({truth, 20.0, 2.0});
  const Fitted untold(log, 3), told(log, 3, truth);
  const double rotor = told.model.model.effects[0].value[0], s = told.model.effect_error[0][0];
  ASSERT_GT(s, 3.0 * 0.003);
  const double moved = untold.model.model.Phi[30 + Iyy] - told.model.model.Phi[30 + Iyy];
  const double added = std::abs(moved / rotor) * std::hypot(rotor, s);
  const double said = std::sqrt(std::pow(untold.unnoticed.error[30 + Iyy], 2) -
                                std::pow(untold.model.Phi_error[30 + Iyy], 2));
  EXPECT_EQ(untold.effect_at(30 + Iyy), "rotor_inertia@joint3");
  EXPECT_GT(said / added, 0.6);
}

TEST(Unnoticed, NeverIsTheErrorSmallerThanTheStandardError) {
  const Fitted fitted(record({{effect("viscous_friction", 1, {0.3})}}), 2);
  for (Eigen::Index p = 0; p < 40; ++p) {
    EXPECT_GE(fitted.unnoticed.error[p], fitted.model.Phi_error[p]) << p;
    const bool sought = p >= 20 && p < 30;
    EXPECT_EQ(fitted.unnoticed.error[p] > 0.0, sought) << p;
    EXPECT_TRUE(sought || fitted.effect_at(p).empty()) << p;
  }
}

/// More data leave less room: four times the time, half the error, of what is seen at all. (Five
/// logs: the ratio is one between two numbers of some twenty degrees of freedom each.)
TEST(Unnoticed, ShrinksWithTheLength) {
  const Eigen::Index number = 30 + Iyy;
  double squares[2] = {0.0, 0.0};
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    squares[0] += std::pow(Fitted(record({{}, 20.0, 0.2, seed}), 3).unnoticed.error[number], 2);
    squares[1] += std::pow(Fitted(record({{}, 80.0, 0.2, seed}), 3).unnoticed.error[number], 2);
  }
  const double ratio = std::sqrt(squares[0] / squares[1]);
  EXPECT_GT(ratio, 1.4);
  EXPECT_LT(ratio, 2.9);
}

TEST(Unnoticed, AMassThatNoErrorBringsNearTheGivenIsFar) {
  const Recording log = record({});
  for (const double times : {0.3, 0.7, 1.0, 1.8, 3.0}) {
    Robot robot = arm();
    InertialParameters& given = robot.links[3].inertia;
    given.values *= times;
    const Fitted fitted(log, 3, {}, robot);
    const bool far = times < 0.5 || times > 2.0;
    EXPECT_EQ(is_far_from_given(robot, fitted.model, fitted.unnoticed.error, 3), far) << times;
    const auto surely = [&](const Consistent& model) {
      return is_surely_far_from_given(robot, {3}, model, fitted.unnoticed.error, 0);
    };
    EXPECT_EQ(surely(fitted.model), far) << times;
    Consistent unknown = fitted.model;
    unknown.data.determined[0] = false;
    EXPECT_FALSE(surely(unknown)) << times;
    Unnoticed unsure = fitted.unnoticed;
    unsure.error[30] = 10.0;  // kg
    EXPECT_FALSE(is_far_from_given(robot, fitted.model, unsure.error, 3)) << times;
    given.values.setZero();
    EXPECT_FALSE(is_far_from_given(robot, fitted.model, fitted.unnoticed.error, 3))
        << "none is given";
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
