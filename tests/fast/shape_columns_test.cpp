// Pricing in single precision picks the shape that double would, but for what single cannot tell.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "shapeid/fast/column_products.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// 13 roundings to single precision of terms that add up to one, on each side of a comparison.
constexpr double single_rounding = 2.0 * 13.0 / (1 << 24);
/// The lane's number takes the place of a price's last four bits.
constexpr double lane_bits = 16.0 / (1 << 24);

/// Shapes on links, some without numbers, some barred; lengths of all magnitudes.
struct Market {
  int links;
  VectorXd lengths, g;
  double length;
  std::vector<int> link_of;
  std::vector<ShapeColumns::Column> columns;
  std::vector<bool> barred;

  [[nodiscard]] ShapeColumns stored() const {
    ShapeColumns stored(links, static_cast<int>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j) {
      RC_ASSERT(stored.append(link_of[j], columns[j]));
    }
    stored.set_scale(lengths, length);
    for (std::size_t j = 0; j < columns.size(); ++j) stored.bar(static_cast<int>(j), barred[j]);
    return stored;
  }

  [[nodiscard]] double price(int j) const {
    const auto at = static_cast<std::size_t>(j);
    const Index first = Index{10} * link_of[at];
    const double most = columns[at].cwiseAbs().dot(lengths.segment<10>(first)) * length;
    return most > 0.0 ? columns[at].dot(g.segment<10>(first)) / most : 0.0;
  }

  /// The slope over the sum of its own terms.
  [[nodiscard]] double price_by_terms(int j) const {
    const auto at = static_cast<std::size_t>(j);
    const auto gl = g.segment<10>(Index{10} * link_of[at]);
    const double most = columns[at].cwiseAbs().dot(gl.cwiseAbs());
    return most > 0.0 ? columns[at].dot(gl) / most : 0.0;
  }

  [[nodiscard]] int steepest() const {
    int best = -1;
    for (int j = 0; j < static_cast<int>(columns.size()); ++j) {
      if (barred[static_cast<std::size_t>(j)]) continue;
      if (best < 0 || price(j) > price(best)) best = j;
    }
    return best;
  }
};

/// `size`: of the slopes, over the largest that they could be.
Market any_market(double size) {
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  Market market;
  market.links = *rc::gen::inRange(1, 6);
  market.lengths.resize(Index{10} * market.links);
  market.g.resize(market.lengths.size());
  market.length = std::pow(10.0, draw.between(-6.0, 6.0));
  for (Index i = 0; i < market.g.size(); ++i) {
    market.lengths[i] = std::pow(10.0, draw.between(-3.0, 3.0));
    market.g[i] = size * draw.sign() * market.lengths[i] * market.length;
  }
  const int shapes = *rc::gen::inRange(0, 80);
  for (int j = 0; j < shapes; ++j) {
    ShapeColumns::Column u;
    const double scale = std::pow(10.0, draw.between(-4.0, 4.0));
    for (double& x : u) x = draw.between(0.0, 1.0) < 0.2 ? 0.0 : scale * draw.sign();
    if (draw.between(0.0, 1.0) < 0.05) u.setZero();
    market.link_of.push_back(static_cast<int>(draw.between(0.0, market.links)));
    market.columns.push_back(u);
    market.barred.push_back(draw.between(0.0, 1.0) < 0.3);
  }
  return market;
}

/// Shapes in any order, some more than once.
RC_GTEST_PROP(ColumnProducts, AsOneByOne, ()) {
  const Market market = any_market(1.0);
  RC_PRE(!market.columns.empty());
  const ShapeColumns stored = market.stored();
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  std::vector<int> shapes;
  for (int k = *rc::gen::inRange(0, 60); k > 0; --k) {
    const int j = static_cast<int>(draw.between(0.0, stored.size()));
    shapes.push_back(j);
    while (draw.between(0.0, 1.0) < 0.8) shapes.push_back(j);  // of a link, one after the other
  }
  const auto n = static_cast<Index>(shapes.size());
  constexpr double untouched = 3.25;
  VectorXd products = VectorXd::Constant(n + 1, untouched);
  column_products(stored, shapes, market.g, products);
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(shapes[static_cast<std::size_t>(i)]);
    const auto g = market.g.segment<10>(Index{10} * market.link_of[at]);
    const double terms = market.columns[at].cwiseAbs().dot(g.cwiseAbs());
    RC_ASSERT(test::scaled(products[i] - market.columns[at].dot(g), terms, 10) <
              test::few_hundred_eps);
  }
  RC_ASSERT(products[n] == untouched);
}

RC_GTEST_PROP(ShapeColumns, SteepestIsThatOfDoubleButForSinglePrecision, ()) {
  const Market market = any_market(1.0);
  ShapeColumns stored = market.stored();
  const int best = market.steepest(), found = stored.steepest(market.g, single_rounding);
  if (best < 0 || market.price(best) < single_rounding / 2.0) {
    RC_ASSERT(found < 0);
  } else if (found < 0) {
    RC_ASSERT(market.price(best) < 2.0 * single_rounding);
  } else {
    RC_ASSERT(!market.barred[static_cast<std::size_t>(found)]);
    RC_ASSERT(market.price(found) >=
              market.price(best) - single_rounding - lane_bits * market.price(best));
  }
}

// Some come before the scale is forgotten, and have other columns since; the others after it.
RC_GTEST_PROP(ShapeColumns, AreAsWellWrittenBeforeTheirScaleIsKnown, ()) {
  const Market market = any_market(1.0);
  ShapeColumns at_once = market.stored();
  ShapeColumns late(market.links, static_cast<int>(market.columns.size()));
  const std::size_t early = market.columns.size() / 2;
  for (std::size_t j = 0; j < early; ++j) {
    RC_ASSERT(late.append(market.link_of[j], ShapeColumns::Column::Constant(3.0)));
  }
  late.forget_scale();
  RC_ASSERT(!late.has_scale());
  for (std::size_t j = 0; j < market.columns.size(); ++j) {
    if (j < early) {
      late.replace(static_cast<int>(j), market.columns[j]);
    } else {
      RC_ASSERT(late.append(market.link_of[j], market.columns[j]));
    }
  }
  late.set_scale(market.lengths, market.length);
  RC_ASSERT(late.has_scale());
  for (std::size_t j = 0; j < market.columns.size(); ++j) {
    late.bar(static_cast<int>(j), market.barred[j]);
  }
  for (int j = 0; j < late.size(); ++j) RC_ASSERT(late.price(j, 1.0) == at_once.price(j, 1.0));
  for (const VectorXd& g : {market.g, VectorXd(-market.g)}) {
    RC_ASSERT(late.steepest(g, single_rounding) == at_once.steepest(g, single_rounding));
  }
}

// Slopes far below what single precision resolves: double decides among all that are not barred,
// with prices whose scale alone is single.
RC_GTEST_PROP(ShapeColumns, DoubleDecidesWhereSingleCannot, ()) {
  const Market market = any_market(1e-9);
  const double threshold = *test::magnitude(1e-13, 1e-9);
  ShapeColumns stored = market.stored();
  const int best = market.steepest(), found = stored.steepest(market.g, threshold);
  if (best < 0 || market.price(best) < threshold * (1.0 - single_rounding)) {
    RC_ASSERT(found < 0);
  } else if (found < 0) {
    RC_ASSERT(market.price(best) < threshold * (1.0 + single_rounding));
  } else {
    RC_ASSERT(!market.barred[static_cast<std::size_t>(found)]);
    RC_ASSERT(market.price(found) >= market.price(best) * (1.0 - single_rounding));
  }
}

// A threshold below zero asks whether all are certainly negative: slopes that are nearer to zero
// than it are found, however small all slopes are.
RC_GTEST_PROP(ShapeColumns, NoneIsMissedAboveAThresholdBelowZero, ()) {
  Market market = any_market(std::pow(10.0, *rc::gen::element(-18, -15, -13, -12, -9)));
  for (Index i = 0; i < market.g.size(); ++i) market.g[i] = -std::abs(market.g[i]);
  for (ShapeColumns::Column& u : market.columns) u = u.cwiseAbs().eval();
  const double threshold = -*test::magnitude(1e-14, 1e-10);
  ShapeColumns stored = market.stored();
  const int best = market.steepest(), found = stored.steepest(market.g, threshold);
  if (best < 0 || market.price(best) < threshold * (1.0 + single_rounding)) {
    RC_ASSERT(found < 0);
  } else if (market.price(best) > threshold * (1.0 - single_rounding)) {
    RC_ASSERT(found >= 0);
    RC_ASSERT(!market.barred[static_cast<std::size_t>(found)]);
    RC_ASSERT(market.price(found) >= market.price(best) * (1.0 + single_rounding));
  }
}

// Slopes R^T r with || r || no longer than said cannot have a price beyond one.
RC_GTEST_PROP(ShapeColumns, PricesLieBetweenMinusOneAndOne, ()) {
  Market market = any_market(1.0);
  test::Draw draw(*rc::gen::arbitrary<std::uint64_t>());
  for (Index i = 0; i < market.g.size(); ++i) {
    market.g[i] = (draw.sign() < 0.0 ? -1.0 : 1.0) * market.lengths[i] * market.length;
  }
  const ShapeColumns stored = market.stored();
  for (int j = 0; j < stored.size(); ++j) {
    const double slope = stored.column(j).dot(market.g.segment<10>(Index{10} * stored.link(j)));
    const double price = stored.price(j, slope);
    RC_ASSERT(std::abs(price) <= 1.0 + single_rounding);
    RC_ASSERT(std::abs(price - market.price(j)) <= single_rounding * std::abs(price));
  }
}

// Units are factors; powers of two change no digit, so they must not change the choice.
RC_GTEST_PROP(ShapeColumns, UnitsDoNotChangeTheChoice, ()) {
  const double size = *rc::gen::element(1.0, 1e-9);
  Market market = any_market(size);
  ShapeColumns stored = market.stored();
  const int chosen = stored.steepest(market.g, 1e-12);
  const double of_rows = std::ldexp(1.0, *rc::gen::inRange(-40, 41));
  const double of_forces = std::ldexp(1.0, *rc::gen::inRange(-40, 41));
  market.lengths *= of_rows;
  market.length *= of_forces;
  market.g *= of_rows * of_forces;
  ShapeColumns other = market.stored();
  RC_ASSERT(other.steepest(market.g, 1e-12) == chosen);
}

RC_GTEST_PROP(ShapeColumns, BarredShapesComeBackWhenAdmitted, ()) {
  Market market = any_market(1.0);
  ShapeColumns stored = market.stored();
  stored.unbar_all();
  std::fill(market.barred.begin(), market.barred.end(), false);
  ShapeColumns fresh = market.stored();
  RC_ASSERT(stored.steepest(market.g, 1e-14) == fresh.steepest(market.g, 1e-14));
  for (int j = 0; j < stored.size(); ++j) stored.bar(j, true);
  RC_ASSERT(stored.steepest(market.g, 1e-14) == -1);
}

// A column that is written later counts as if it had come first.
RC_GTEST_PROP(ShapeColumns, ReplacedColumnsArePricedAnew, ()) {
  Market market = any_market(1.0);
  ShapeColumns stored = market.stored();
  for (std::size_t j = 0; j < market.columns.size(); j += 3) {
    market.columns[j] = 2.0 * market.columns[market.columns.size() - 1 - j].reverse().eval();
    stored.replace(static_cast<int>(j), market.columns[j]);
  }
  ShapeColumns fresh = market.stored();
  RC_ASSERT(stored.steepest(market.g, 1e-14) == fresh.steepest(market.g, 1e-14));
  for (int j = 0; j < stored.size(); ++j) RC_ASSERT(stored.column(j) == fresh.column(j));
}

// Slopes of any size below what single precision sees by lengths: by their own terms the steepest
// is found to single precision all the same, unless one is above the threshold by lengths.
RC_GTEST_PROP(ShapeColumns, SmallSlopesAreJudgedByTheirOwnTerms, ()) {
  constexpr double by_lengths = 1e-14, by_terms = 1e-12;
  const Market market = any_market(std::pow(10.0, *rc::gen::element(-20, -15, -12, -8, -3, 0)));
  ShapeColumns stored = market.stored();
  const int chosen = stored.steepest_or_by_terms(market.g, by_lengths, by_terms);
  ShapeColumns fresh = market.stored();
  const int steepest = fresh.steepest(market.g, by_lengths);
  if (steepest >= 0 && market.price(steepest) > single_rounding + lane_bits) {
    RC_ASSERT(chosen >= 0);
    RC_ASSERT(market.price(chosen) >= (1.0 - lane_bits) * market.price(steepest) - single_rounding);
    return;
  }
  double most = 0.0;
  for (int j = 0; j < static_cast<int>(market.columns.size()); ++j) {
    if (!market.barred[static_cast<std::size_t>(j)])
      most = std::max(most, market.price_by_terms(j));
  }
  if (chosen < 0) {
    RC_ASSERT(most <= by_terms);
  } else if (market.price(chosen) <= by_lengths) {
    RC_ASSERT(market.price_by_terms(chosen) > 0.0);
    RC_ASSERT(market.price_by_terms(chosen) >= (1.0 - lane_bits) * most - single_rounding);
  }
  RC_ASSERT(stored.steep_ones(ShapeColumns::Among::all).empty() == (chosen < 0));
}

TEST(ShapeColumns, RoomIsForAllShapesOnAnyLinks) {
  for (int on_first = 0; on_first <= 40; ++on_first) {
    ShapeColumns stored(3, 40);
    for (int j = 0; j < 40; ++j) {
      ASSERT_TRUE(stored.append(j < on_first ? 0 : 1 + j % 2, ShapeColumns::Column::Ones()));
    }
    EXPECT_FALSE(stored.append(2, ShapeColumns::Column::Ones()));
    EXPECT_EQ(stored.size(), 40);
    stored.clear();
    EXPECT_EQ(stored.size(), 0);
    EXPECT_TRUE(stored.append(2, ShapeColumns::Column::Ones()));
    EXPECT_EQ(stored.link(0), 2);
  }
}

// Rows that do not feel a link: no price, and no NaN that would win or hide a comparison.
TEST(ShapeColumns, UnfeltShapesHaveNoPrice) {
  ShapeColumns stored(2, 4);
  for (const int link : {0, 1, 0, 1}) {
    ASSERT_TRUE(stored.append(link, ShapeColumns::Column::Ones()));
  }
  VectorXd lengths = VectorXd::Ones(20), g = VectorXd::Zero(20);
  lengths.head<10>().setZero();
  stored.set_scale(lengths, 1.0);
  EXPECT_EQ(stored.price(0, 0.0), 0.0);
  EXPECT_EQ(stored.steepest(g, 0.0), -1);
  g[13] = 0.5;
  EXPECT_EQ(stored.link(stored.steepest(g, 0.0)), 1);
  stored.set_scale(VectorXd::Zero(20), 0.0);
  EXPECT_EQ(stored.steepest(VectorXd::Zero(20), 0.0), -1);
}

// A threshold below zero asks whether all shapes are certainly held: none at all, or only where
// even the closest to entering is further away.
TEST(ShapeColumns, ThresholdsBelowZeroFindWhatIsNotCertainlyHeld) {
  ShapeColumns stored(1, 3);
  for (int j = 0; j < 3; ++j) {
    ASSERT_TRUE(stored.append(0, ShapeColumns::Column::Unit(j)));
  }
  stored.set_scale(VectorXd::Ones(10), 1.0);
  VectorXd g = VectorXd::Constant(10, -0.5);
  EXPECT_EQ(stored.steepest(g, -1e-13), -1);
  g[1] = -1e-12;
  EXPECT_EQ(stored.steepest(g, -1e-13), -1);
  g[1] = -1e-14;
  EXPECT_EQ(stored.steepest(g, -1e-13), 1);
  EXPECT_NE(stored.steepest(VectorXd::Zero(10), -1e-13), -1);
}

/// Two links of twenty shapes, more than one chunk each: what enters beside the steepest.
TEST(ShapeColumns, SteepOnesAreTheBestOfOtherLinksOrSixteens) {
  constexpr int each = 20;
  ShapeColumns columns(2, 2 * each);
  for (int j = 0; j < 2 * each; ++j) {
    // The share of the first parameter is the price for each unit of its slope.
    const double share = j == 3 || j == 25 ? 0.9 : j == 18 || j == 38 ? 0.8 : 0.3;
    ShapeColumns::Column u = ShapeColumns::Column::Zero();
    u[0] = share;
    u[1] = 1.0 - share;
    ASSERT_TRUE(columns.append(j / each, u));
  }
  using Among = ShapeColumns::Among;
  const auto steep = [&](double second_link, Among among) {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(20);
    g[0] = 1.0;
    g[10] = second_link;
    const int steepest = columns.steepest(g, 0.0);
    const std::vector<int>& found = columns.steep_ones(among);
    EXPECT_EQ(found.front(), steepest);
    return std::set<int>(found.begin(), found.end());
  };
  EXPECT_EQ(steep(0.5, Among::links), (std::set{3, 25}));
  EXPECT_EQ(steep(2.0, Among::links), (std::set{3, 25}));
  EXPECT_EQ(steep(0.5, Among::all), (std::set{3, 18, 25, 38}));
  // Less than a tenth of the largest price is not almost as large; where any may enter, three.
  EXPECT_EQ(steep(0.05, Among::links), (std::set{3}));
  EXPECT_EQ(steep(0.2, Among::links), (std::set{3, 25}));
  EXPECT_EQ(steep(0.2, Among::all), (std::set{3, 18}));
  EXPECT_EQ(steep(-0.5, Among::all), (std::set{3, 18}));
}

/// Slopes whose terms cancel to less than single precision sees: double decides of each shape, and
/// any that is almost as steep enters beside the steepest, also of the same sixteen.
TEST(ShapeColumns, SteepOnesAreThoseThatDoubleFinds) {
  constexpr double tiny = 1e-9;
  ShapeColumns columns(2, 10);
  for (const double steepness : {1.0, 0.5, 0.2, -1.0, 0.4, 0.9, 0.0, 0.35, 1.0, 0.9}) {
    ShapeColumns::Column u = ShapeColumns::Column::Zero();
    u[0] = 1.0 + tiny * steepness;
    u[1] = 1.0;
    ASSERT_TRUE(columns.append(columns.size() % 2, u));
  }
  VectorXd g = VectorXd::Zero(20);
  g[0] = g[10] = 1.0;
  g[1] = g[11] = -1.0;
  using Among = ShapeColumns::Among;
  const auto steep = [&](Among among) {
    const std::vector<int>& found = columns.steep_ones(among);
    return std::set<int>(found.begin(), found.end());
  };
  for (const double by_lengths : {1e-14, 1e-3}) {  // judged by their terms then
    EXPECT_EQ(columns.steepest_or_by_terms(g, by_lengths, 1e-12), 0);
    EXPECT_EQ(steep(Among::all), (std::set{0, 1, 4, 5, 7, 8, 9}));
  }
  EXPECT_EQ(columns.steepest(g, 1e-14), 0);
  EXPECT_EQ(steep(Among::links), (std::set{0, 5}));
  // Twins of the steepest ones do not enter with them where one of a link does.
  EXPECT_EQ(columns.steepest_or_by_terms(g, 1e-14, 1e-12), 0);
  EXPECT_EQ(steep(Among::links), (std::set{0, 5}));
}

}  // namespace
}  // namespace shapeid::fast
