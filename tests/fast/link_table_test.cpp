// The first answer for any number of shapes of a link: how often it is right, that a wrong one is
// refused, and what it keeps as shapes are divided.
#include "shapeid/fast/link_table.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "shapeid/fast/tableau.hpp"
#include "shapeid/fast/tableau_pivots.hpp"
#include "shapeid/fast/wide.hpp"
#include "shapeid/tests/fast/judged_guess.hpp"

namespace shapeid::fast {
namespace {

using test::JudgedGuess;
using test::TriangleCase;

constexpr auto by_table = test::GuessBy::link_table;

TEST(LinkTable, IsSettledAlmostAlwaysWithoutLambda) {
  for (const bool warm : {false, true}) {
    EXPECT_GE(test::settled_guesses(by_table, 60, false, warm), 295);
  }
}

TEST(LinkTable, IsSettledWhereMostShapesHaveNeitherMassNorSlope) {
  for (const bool warm : {false, true}) {
    // All 300 where this was written; fewer than 290 if no shape is let go.
    EXPECT_GE(test::settled_guesses(by_table, 60, false, warm, 0.0), 298);
  }
}

// With lambda only where the rows alone decide which shapes have mass.
TEST(LinkTable, IsSettledOftenWithLambda) {
  // 143 where this was written: up to ten shapes or so.
  for (const bool warm : {false, true}) {
    EXPECT_GE(test::settled_guesses(by_table, 60, true, warm), 120);
  }
}

RC_GTEST_PROP(LinkTable, OfOtherForcesIsCorrectedOrRefused, ()) {
  test::check_guess_of_other_forces(by_table, 39);
}

TEST(LinkTable, OfAnotherWindowIsRefused) { EXPECT_GE(test::refused_guesses(by_table, 25), 80); }

RC_GTEST_PROP(LinkTable, KeepsInverseAndMinimumAsShapesAreDivided, ()) {
  test::check_divided_guess(by_table, 4, 1.0);
}

RC_GTEST_PROP(LinkTable, MovesMassAsShapesAreDividedWithinTheSpan, ()) {
  test::check_guess_divided_within_span();
}

TEST(LinkTable, HasRoomForADozenPassiveShapes) {
  const TriangleCase given = test::link_case(1, 20, true);
  std::vector<int> passive(LinkTable::most_passive);
  std::iota(passive.begin(), passive.end(), 0);
  JudgedGuess judged(by_table, given);
  EXPECT_TRUE(judged.start(given.R, given.problem.lambda, passive));
  passive.push_back(12);
  EXPECT_FALSE(judged.start(given.R, given.problem.lambda, passive));
}

// Without forces there is no mass, whatever was passive.
TEST(LinkTable, WithoutForcesIsEmpty) {
  TriangleCase given = test::link_case(3, 15, false);
  given.R.rightCols<1>().setZero();
  given.problem.F.setZero();
  JudgedGuess judged(by_table, given);
  ASSERT_TRUE(judged.start(given.R, 0.0, {1, 4, 7}));
  ASSERT_TRUE(judged.settles());
  EXPECT_EQ(judged.guess().answer().used, 0U);
}

/// Where rounding has made a mass's entry of K negative, or nothing, holding the mass at zero has
/// no cost that could stand out. The first place, which then is found, is used by no shape here.
TEST(LinkTable, StopsWhereRoundingLeavesNoPlaceToLeave) {
  tableau::Tableau table;
  tableau::Problem problem;
  for (std::size_t p = 0; p < 3; ++p) table.m.part[p] = table.diagonal.part[p] = Four{} + 1.0;
  table.places = 3;
  table.used = 0b110;
  table.count = 2;
  // The mass's square over these is below -1, infinite, or no number.
  for (const double entry : {-1e-3, -0.0, std::numeric_limits<double>::quiet_NaN()}) {
    table.m[1] = -1.0;
    table.diagonal[1] = entry;
    int pivots = 0;
    EXPECT_EQ(tableau::pivot(table, problem, 5, pivots), tableau::Stop::endless);
    EXPECT_EQ(table.count, 2);
    EXPECT_EQ(table.used, 0b110U);
  }
}

}  // namespace
}  // namespace shapeid::fast
