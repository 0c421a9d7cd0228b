// Whether a candidate's numbers can be what it says.
#include "shapeid/diagnosis/credibility.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

#include "shapeid/models/shape.hpp"
#include "shapeid/models/student.hpp"
#include "shapeid/tests/diagnosis/planted.hpp"

namespace shapeid::diagnosis {
namespace {

using planted::law;
using planted::one_number;
using planted::Planted;

/// Of one candidate, whatever the log holds.
class OfOne {
 public:
  OfOne(Planted& log, const SelectionRule& rule)
      : fits_(log.fits()),
        contenders_(fits_, log.masses(), log.candidates()),
        rule_(rule),
        credibility_(fits_, contenders_, rule_) {}

  [[nodiscard]] const Credibility& operator*() const { return credibility_; }
  [[nodiscard]] const Credibility* operator->() const { return &credibility_; }
  [[nodiscard]] bool credible(std::size_t k) const {
    return credibility_.credible(k, {}, fits_.fit(contenders_.terms({})),
                                 fits_.fit(contenders_.terms({}, k)));
  }

 private:
  BlockFits fits_;
  Contenders contenders_;
  SelectionRule rule_;
  Credibility credibility_;
};

Fit own_numbers(std::initializer_list<double> values, double error) {
  Fit fit;
  fit.value = Eigen::Map<const Eigen::VectorXd>(values.begin(), std::ssize(values));
  fit.standard_error = fit.between_blocks = Eigen::VectorXd::Constant(fit.value.size(), error);
  return fit;
}

TEST(Credibility, ASignIsWrongBeyondItsErrorAndOnlyWhereItMatters) {
  Planted log(21);
  Effect friction = law("friction", 2);
  friction.parameters[1].nonnegative = true;
  const std::size_t k = log.add(friction, log.normal(2));
  log.add_noise();
  const OfOne of(log, {});
  EXPECT_FALSE(of->wrong_sign(k, own_numbers({-9.0, 1.0}, 1.0), 0.0));
  EXPECT_TRUE(of->wrong_sign(k, own_numbers({1.0, -0.1}, 1.0), 0.0));
  EXPECT_FALSE(of->wrong_sign(k, own_numbers({1.0, -1.9}, 1.0), 2.0));
  EXPECT_TRUE(of->wrong_sign(k, own_numbers({1.0, -2.1}, 1.0), 2.0));
}

TEST(Credibility, NumbersHaveARangeAndThoseOfChangesBeginWhereTheyAre) {
  Planted log(22);
  Effect length = law("length", 2), change = law("change", 2);
  length.parameters[0].limit = change.parameters[0].limit = 3.0;
  change.transform.robot = [](Robot&, int, const Eigen::VectorXd&) {};
  const std::size_t plain = log.add(length, log.normal(2));
  const std::size_t moved = log.add(change, log.normal(2));
  log.candidates()[plain].effect.value[0] = log.candidates()[moved].effect.value[0] = 1.0;
  const std::size_t push = log.add(law("force", 1, "N"), log.normal(1));
  log.add_noise();
  SelectionRule rule;
  rule.most_force = 10.0;
  const OfOne of(log, rule);
  EXPECT_TRUE(of->within_limits(plain, {}, own_numbers({-2.9, 1e9}, 1.0)));
  EXPECT_FALSE(of->within_limits(plain, {}, own_numbers({-3.1, 0.0}, 1.0)));
  EXPECT_FALSE(of->within_limits(moved, {}, own_numbers({2.9, 0.0}, 1.0)));
  EXPECT_TRUE(of->within_limits(moved, {}, own_numbers({-3.9, 0.0}, 1.0)));
  EXPECT_TRUE(of->within_limits(push, {}, own_numbers({9.9}, 1.0)));
  EXPECT_FALSE(of->within_limits(push, {}, own_numbers({-10.1}, 1.0)));
}

/// More is asked of one of many, and of what was chosen among many before.
TEST(Credibility, TheMoreIsTriedTheMoreIsAsked) {
  const auto credible = [](double standard_errors, std::size_t candidates, double choices) {
    Planted log(23);
    const std::size_t k = log.add(law("law"), log.normal(1));
    log.candidates()[k].choices = choices;
    log.plant(k, one_number(Planted::size_of(standard_errors)));
    log.add_noise();
    for (std::size_t i = 1; i < candidates; ++i) {
      log.add(law(fmt::format("law{}", i)), log.normal(1));
    }
    return OfOne(log, {}).credible(k);
  };
  const auto least = [&](std::size_t candidates, double choices) {
    double z = 0.0;
    while (!credible(z, candidates, choices)) z += 0.25;
    return z;
  };
  const double few = least(1, 1.0);
  EXPECT_GT(few, 2.0);
  EXPECT_LT(few, 8.0);
  EXPECT_GT(least(200, 1.0), few);
  EXPECT_GT(least(1, 1e6), few);
}

TEST(Credibility, ALargeNumberBeyondItsRangeIsNotCredible) {
  const double size = Planted::size_of(30.0);
  for (const double limit : {2.0 * size, 0.5 * size}) {
    Planted log(28);
    Effect length = law("length");
    length.parameters[0].limit = limit;
    const std::size_t k = log.add(length, log.normal(1));
    log.plant(k, one_number(size));
    log.add_noise();
    EXPECT_EQ(OfOne(log, {}).credible(k), limit > size);
  }
}

/// Ten numbers of a load with its mass at two places near its link, at one too far away, or without
/// any.
TEST(Credibility, ALoadIsABodyNearItsLink) {
  Effect load = law("load", 10);
  load.is_payload = true;
  const auto at = [](double x, double y, double z) {
    return Eigen::VectorXd(unit_parameters(make_point({x, y, z}, 1.0)).values);
  };
  Eigen::VectorXd no_mass = at(0.3, 0.1, -0.2);
  no_mass[0] = 0.0;
  const std::vector<std::pair<Eigen::VectorXd, bool>> loads = {
      {at(0.3, 0.1, -0.2) + at(-0.1, 0.2, 0.4), true},
      {at(0.3, 0.1, -2.0), false},
      {no_mass, false},
      {-at(0.3, 0.1, -0.2), false}};
  for (const auto& [Phi, is_one] : loads) {
    Planted log(24);
    const std::size_t k = log.add(load, log.normal(10));
    log.plant(k, Planted::size_of(60.0) * Phi);
    log.add_noise();
    EXPECT_EQ(OfOne(log, {}).credible(k), is_one) << Phi.transpose();
  }
}

/// Two columns are nearly the same, so that neither number is known, and the load is.
TEST(Credibility, ALoadIsKnownAsOneWhereItsNumbersAreNot) {
  Effect load = law("load", 10);
  load.is_payload = true;
  const Eigen::VectorXd Phi = unit_parameters(make_point({0.3, 0.1, -0.2}, 1.0)).values;
  for (const double standard_errors : {0.0, 25.0}) {
    Planted log(31);
    Eigen::MatrixXd columns = 0.01 * log.normal(10);
    const Eigen::VectorXd same = log.normal(1);
    columns.col(0) += same;
    columns.col(1) += same;
    const std::size_t k = log.add(load, columns);
    log.plant(k, Planted::size_of(standard_errors) * Phi);
    log.add_noise();
    EXPECT_EQ(OfOne(log, {}).credible(k), standard_errors > 0.0);
  }
}

/// A ripple beside others is judged where it stands.
TEST(Credibility, ARippleIsOneByItselfIfItIsThere) {
  for (const double planted : {0.0, 25.0}) {
    Planted log(25);
    const std::size_t other = log.add(law("other"), log.normal(1));
    const std::size_t k = log.add(law("ripple", 2), log.normal(2));
    log.candidates()[k].choices = 20.0;
    log.plant(other, one_number(Planted::size_of(40.0)));
    log.plant(k, Planted::size_of(planted) * Eigen::Vector2d(0.6, -0.8));
    log.add_noise();
    const BlockFits fits = log.fits();
    const Contenders contenders(fits, log.masses(), log.candidates());
    const SelectionRule rule;
    const Credibility credibility(fits, contenders, rule);
    const Fit all = fits.fit(contenders.terms({k, other}));
    EXPECT_EQ(credibility.ripples(k, {other}, all, part_of(all, contenders.first_column(), 2)),
              planted > 0.0);
    EXPECT_EQ(credibility.is_by_itself(k, {other}, 12.0), planted > 0.0);
  }
}

/// What acts late is judged by the blocks in which it acts, with the limit of so many.
TEST(Credibility, GainOfWhatCameLateIsThatOfItsBlocks) {
  Planted log(26);
  constexpr std::size_t from = 16;
  const std::size_t late = log.add(law("late"), log.normal(1), 0, from);
  const std::size_t always = log.add(law("always"), log.normal(1));
  log.add_noise();
  const OfOne of(log, {});
  constexpr Eigen::Index blocks = Planted::blocks, acts = blocks - from;
  Eigen::VectorXd before = 10.0 * Eigen::VectorXd::Ones(blocks) + log.normal(1).topRows(blocks);
  Eigen::VectorXd after = before;
  after.tail(acts).array() -= 1.0;
  after.tail(acts) -= 0.1 * log.normal(1).topRows(acts);
  EXPECT_EQ(of->gain_by(always, before, after).t, gain_of(before, after).t);
  const double own = gain_of(before.tail(acts), after.tail(acts)).t;
  const double least_t = SelectionRule{}.least_t;
  const Gain gain = of->gain_by(late, before, after);
  EXPECT_GT(gain.t, gain_of(before, after).t);
  EXPECT_DOUBLE_EQ(gain.t, own * limit_for(least_t, blocks) / limit_for(least_t, acts));
  EXPECT_EQ(gain.share, gain_of(before, after).share);
}

TEST(Credibility, WhatPassesGainsAndByMoreThanTheLimit) {
  Planted log(27);
  log.add(law("law"), log.normal(1));
  log.add_noise();
  const SelectionRule rule;
  const OfOne of(log, rule);
  const double limit = limit_for(rule.least_t, Eigen::Index{Planted::blocks});
  EXPECT_GT(limit, rule.least_t);
  const auto scored = [](double gain, double t) { return Scored{0, gain, t, {}, false}; };
  EXPECT_TRUE(of->passes(scored(0.1, 1.01 * limit)));
  EXPECT_FALSE(of->passes(scored(0.1, 0.99 * limit)));
  EXPECT_FALSE(of->passes(scored(-0.1, 1.01 * limit)));
}

}  // namespace
}  // namespace shapeid::diagnosis
