// Grids over the numbers that columns do not depend on linearly.
#include "shapeid/diagnosis/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {
namespace {

Effect with_shape(std::vector<ShapeNumber> numbers) {
  Effect effect;
  effect.id = "some_law";
  effect.shape = std::move(numbers);
  return effect;
}

/// Of logarithms of a few units, and relative of what they are of: some ten roundings.
constexpr double off_by_rounding = 1e-14;

constexpr double block = 7.5;  // s

TEST(ShapeVariants, GoFromTheLeastToTheMostInEqualRatios) {
  const Effect effect = with_shape({{"width", "rad/s", 0.01, 2.56, 0.3}});
  const std::vector<AppliedEffect> variants = shape_variants(at_start(effect, 3), 0, block);
  ASSERT_EQ(variants.size(), 10U);
  EXPECT_EQ(variants[0].shape[0], 0.3) << "the present one first";
  for (std::size_t i = 1; i < variants.size(); ++i) {
    EXPECT_NEAR(variants[i].shape[0] / (0.01 * std::pow(2.0, static_cast<double>(i) - 1.0)), 1.0,
                off_by_rounding);
    EXPECT_EQ(variants[i].site, 3);
    EXPECT_EQ(variants[i].effect, &effect);
  }
}

/// Each pass looks one step of the last one to either side.
TEST(ShapeVariants, ZoomInAboutThePresentOne) {
  const Effect effect = with_shape({{"width", "rad/s", 0.01, 2.56, 0.3}});
  double step = std::log(2.0);
  for (int pass = 1; pass < 4; ++pass) {
    const std::vector<AppliedEffect> variants = shape_variants(at_start(effect, 0), pass, block);
    EXPECT_NEAR(std::log(variants[1].shape[0] / 0.3), -step, off_by_rounding) << pass;
    EXPECT_NEAR(std::log(variants[9].shape[0] / 0.3), step, off_by_rounding) << pass;
    EXPECT_NEAR(variants[5].shape[0], 0.3, off_by_rounding) << pass;
    step /= 4.0;
  }
}

/// As close that the search nearby, which goes on from the best, reaches from each to the next.
TEST(DistantVariants, GoFromHalfToTwiceInEqualRatios) {
  const double nearby = 0.03;
  const Effect effect =
      with_shape({{"width", "rad/s", 0.01, 2.56, 0.3}, {"N", "1", 4, 200, 12, nearby}});
  const std::vector<AppliedEffect> variants = distant_variants(at_start(effect, 3));
  ASSERT_GT(variants.size(), 3U);
  EXPECT_EQ(variants[0].shape[1], 12.0) << "the present one first";
  EXPECT_NEAR(variants[1].shape[1] / 6.0, 1.0, off_by_rounding);
  EXPECT_NEAR(variants.back().shape[1] / 24.0, 1.0, off_by_rounding);
  const double ratio = variants[2].shape[1] / variants[1].shape[1];
  EXPECT_LT(ratio, (1.0 + nearby) / (1.0 - nearby));
  for (std::size_t i = 2; i < variants.size(); ++i) {
    EXPECT_NEAR(variants[i].shape[1] / variants[i - 1].shape[1] / ratio, 1.0, off_by_rounding);
    EXPECT_EQ(variants[i].shape[0], 0.3) << "has a range of its own";
    EXPECT_EQ(variants[i].site, 3);
  }
}

TEST(DistantVariants, StayWithinTheirLimits) {
  const Effect effect = with_shape({{"N", "1", 4.0, 200.0, 5.0, 0.03}});
  for (const AppliedEffect& a : distant_variants(at_start(effect, 0))) EXPECT_GE(a.shape[0], 4.0);
  AppliedEffect fast = at_start(effect, 0);
  fast.shape[0] = 150.0;
  for (const AppliedEffect& a : distant_variants(fast)) EXPECT_LE(a.shape[0], 200.0);
}

TEST(DistantVariants, AreOneOfWhatIsSoughtOverItsWholeRange) {
  const Effect effect = with_shape({{"width", "rad/s", 0.01, 2.56, 0.3}});
  EXPECT_EQ(distant_variants(at_start(effect, 0)).size(), 1U);
}

TEST(ShapeVariants, StayWithinTheirLimits) {
  const Effect effect = with_shape({{"width", "rad/s", 0.1, 0.4, 0.11}});
  const std::vector<AppliedEffect> variants = shape_variants(at_start(effect, 0), 1, block);
  EXPECT_EQ(variants[1].shape[0], 0.1);
  EXPECT_GT(variants[9].shape[0], 0.11);
  for (const AppliedEffect& v : variants) EXPECT_LE(v.shape[0], 0.4);
}

TEST(ShapeVariants, OfANumberThatScreeningPlacedAreNearIt) {
  ShapeNumber period{"N", "1/turn", 1.0, 1000.0, 10.0};
  period.nearby = 0.02;
  const Effect effect = with_shape({period});
  AppliedEffect found = at_start(effect, 0);
  found.shape[0] = 87.0;
  const std::vector<AppliedEffect> variants = shape_variants(found, 0, block);
  EXPECT_NEAR(variants[1].shape[0], 87.0 * 0.98, 87.0 * off_by_rounding);
  EXPECT_NEAR(variants[9].shape[0], 87.0 * 1.02, 87.0 * off_by_rounding);
}

/// Of a time in a log only the block is known that holds it, early and late in the log alike.
/// (Within a tenth of it, as it was sought, are 0.2 s at 2 s, and a load that came at 11.3 s was
/// put 0.3 s too early.)
TEST(ShapeVariants, OfAMomentAreEvenWithinABlock) {
  const Effect effect = with_shape({{"onset", "s", 0.1, 1e5, 1.0, 0.0, true}});
  for (const double sought : {9.0, 251.3}) {
    AppliedEffect best = at_start(effect, 0);
    best.shape[0] = sought + 0.9 * block;
    for (int pass = 0; pass < 3; ++pass) {
      const std::vector<AppliedEffect> variants = shape_variants(best, pass, block);
      EXPECT_NEAR(variants[9].shape[0] - variants[1].shape[0], 2.0 * block / std::pow(4.0, pass),
                  1e-9);
      const auto off = [&](const AppliedEffect& v) { return std::abs(v.shape[0] - sought); };
      best = *std::min_element(variants.begin(), variants.end(),
                               [&](const auto& a, const auto& b) { return off(a) < off(b); });
    }
    EXPECT_NEAR(best.shape[0], sought, block / 64.0 / 2.0 + 1e-9);
  }
  const std::vector<AppliedEffect> first = shape_variants(at_start(effect, 0), 0, block);
  EXPECT_EQ(first[1].shape[0], 0.1) << "none before the log";
  EXPECT_EQ(distant_variants(at_start(effect, 0)).size(), 1U);
}

/// Five values each where there are two numbers, in every combination, and the present ones.
TEST(ShapeVariants, OfTwoNumbersAreCombined) {
  const Effect effect = with_shape({{"a", "1", 1.0, 16.0, 3.0}, {"b", "1", 0.01, 100.0, 1.0}});
  const std::vector<AppliedEffect> variants = shape_variants(at_start(effect, 0), 0, block);
  ASSERT_EQ(variants.size(), 36U);
  const auto has = [&](double a, double b) {
    return std::any_of(variants.begin(), variants.end(), [&](const AppliedEffect& v) {
      return std::abs(v.shape[0] / a - 1.0) < off_by_rounding &&
             std::abs(v.shape[1] / b - 1.0) < off_by_rounding;
    });
  };
  for (const double a : {3.0, 1.0, 2.0, 4.0, 8.0, 16.0}) {
    for (const double b : {1.0, 0.01, 0.1, 10.0, 100.0}) EXPECT_TRUE(has(a, b)) << a << ' ' << b;
  }
}

/// Passes find a number to a thousandth wherever it is: each grid has it between two values.
TEST(ShapeVariants, CloseInOnANumber) {
  const Effect effect = with_shape({{"width", "rad/s", 0.003, 0.3, 0.05}});
  for (const double sought : {0.003, 0.0047, 0.11, 0.29, 0.3}) {
    AppliedEffect best = at_start(effect, 0);
    for (int pass = 0; pass < 5; ++pass) {
      const std::vector<AppliedEffect> variants = shape_variants(best, pass, block);
      const auto off = [&](const AppliedEffect& v) {
        return std::abs(std::log(v.shape[0] / sought));
      };
      best = *std::min_element(variants.begin(), variants.end(),
                               [&](const auto& a, const auto& b) { return off(a) < off(b); });
    }
    EXPECT_NEAR(best.shape[0] / sought, 1.0, 2e-3) << sought;
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
