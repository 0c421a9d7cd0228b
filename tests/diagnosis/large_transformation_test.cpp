#include "shapeid/diagnosis/large_transformation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "shapeid/tests/diagnosis/planted.hpp"

namespace shapeid::diagnosis {
namespace {

using planted::accepted;
using planted::law;
using planted::one_number;
using planted::Planted;

Effect delay(const std::string& id, int parameters = 1) {
  Effect effect = law(id, parameters, "s");
  effect.transform.robot = [](Robot&, int, const Eigen::VectorXd&) {};
  return effect;
}

constexpr std::array<double, 3> sizes = {60.0, 50.0, 40.0};  // standard errors

/// Three causes, the first of them the largest, as a search accepted them: what is asked for was no
/// candidate then.
struct Several {
  explicit Several(unsigned seed) : log(seed) {
    for (const double errors : sizes) {
      const Eigen::MatrixXd column = log.normal(1);
      columns.push_back(column);
      const std::size_t k = log.add(law("cause " + std::to_string(columns.size())), column);
      log.plant(k, one_number(Planted::size_of(errors)));
    }
    log.add_noise();
  }

  /// The sum of these causes, as they act, from the first-th on, blurred by so much.
  [[nodiscard]] Eigen::MatrixXd sum_from(std::size_t first, double blur = 0.1) {
    Eigen::MatrixXd sum = blur * sizes.at(first) * log.normal(1);
    for (std::size_t i = first; i < columns.size(); ++i) sum += sizes.at(i) * columns[i];
    return sum;
  }

  [[nodiscard]] std::string found(const Selection& selection) {
    const BlockFits fits = log.fits();
    const std::optional<Candidate> large =
        large_transformation(fits, log.masses(), log.candidates(), selection);
    return large ? large->effect.effect->id : "";
  }

  Planted log;
  std::vector<Eigen::MatrixXd> columns;
};

TEST(LargeTransformation, IsWhatTheAcceptedOnesAreTogether) {
  for (const unsigned seed : {3u, 4u, 5u}) {
    Several several(seed);
    const Selection before = several.log.selection();
    ASSERT_EQ(accepted(before).size(), 3u);
    EXPECT_EQ(several.found(before), "");
    several.log.add(delay("no delay"), several.log.normal(1));
    several.log.add(law("no transformation"), several.sum_from(0));
    EXPECT_EQ(several.found(before), "");
    several.log.add(delay("blurred"), several.sum_from(0, 1.0));
    several.log.add(delay("delay"), several.sum_from(0));
    several.log.add(delay("blurred, too"), several.sum_from(0, 1.0));
    EXPECT_EQ(several.found(before), "delay");
  }
}

/// The third cause is a fifth of what all three do, which is not enough, and two fifths of what the
/// strongest leaves, which is. Of that blurred to three fifths it is a quarter.
TEST(LargeTransformation, IsAskedBesideTheStrongestIfNoneDoesEnoughAlone) {
  for (const double blur : {0.0, 0.8}) {
    Several several(6);
    const Selection before = several.log.selection();
    several.log.add(delay("third"), several.sum_from(2, blur));
    EXPECT_EQ(several.found(before), blur > 0.0 ? "" : "third");
  }
}

/// The second number gains a little, less than chance may.
TEST(LargeTransformation, OfTwoThatPredictAlikeHasFewerNumbers) {
  for (const bool is_first : {true, false}) {
    Several several(7);
    const Eigen::MatrixXd weak = several.log.normal(1);
    several.log.plant(several.log.add(law("weak"), weak), one_number(Planted::size_of(3.0)));
    const Selection before = several.log.selection();
    ASSERT_EQ(accepted(before).size(), 3u);
    const Eigen::MatrixXd sum = several.sum_from(0);
    Eigen::MatrixXd two(sum.rows(), 2);
    two << sum, weak;
    if (is_first) several.log.add(delay("two numbers", 2), two);
    several.log.add(delay("one number"), sum);
    if (!is_first) several.log.add(delay("two numbers", 2), two);
    EXPECT_EQ(several.found(before), "one number");
  }
}

/// More numbers count where they predict better.
TEST(LargeTransformation, HasMoreNumbersWhereTheyAreWorthIt) {
  for (const bool is_first : {true, false}) {
    Several several(8);
    const Selection before = several.log.selection();
    Eigen::MatrixXd two(Planted::rows, 2);
    two << several.columns[0], several.sum_from(1);
    if (is_first) several.log.add(delay("two numbers", 2), two);
    several.log.add(delay("one number"), several.columns[0]);
    if (!is_first) several.log.add(delay("two numbers", 2), two);
    EXPECT_EQ(several.found(before), "two numbers");
  }
}

TEST(LargeTransformation, IsNotAskedOfOneCauseNorOfWhatCameSinceTheReference) {
  Several several(9);
  Selection before = several.log.selection();
  const std::size_t k = several.log.add(delay("delay"), several.sum_from(0));
  several.log.candidates()[k].effect.when = When::since_reference;
  EXPECT_EQ(several.found(before), "");
  several.log.candidates()[k].effect.when = When::always;
  EXPECT_EQ(several.found(before), "delay");
  before.accepted.resize(1);
  EXPECT_EQ(several.found(before), "");
}

/// One that was accepted needs no second look.
TEST(LargeTransformation, IsNotOneThatWasAccepted) {
  Several several(10);
  Selection before = several.log.selection();
  const std::size_t k = several.log.add(delay("delay"), several.sum_from(0));
  before.accepted.emplace_back().candidate = k;
  EXPECT_EQ(several.found(before), "");
}

}  // namespace
}  // namespace shapeid::diagnosis
