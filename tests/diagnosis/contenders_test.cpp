// Sets of candidates as terms of fits, and which are looked at.
#include "shapeid/diagnosis/contenders.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "shapeid/tests/diagnosis/planted.hpp"

namespace shapeid::diagnosis {
namespace {

using planted::law;
using planted::one_number;
using planted::Planted;

/// Three single ones, a group of the first two, and one of two numbers.
class OfThem : public ::testing::Test {
 protected:
  OfThem() : log_(11) {
    first_ = log_.add(law("drive"), log_.normal(1), 0);
    second_ = log_.add(law("drive"), log_.normal(1), 1);
    group_ = log_.add_group({first_, second_});
    Effect searched = law("searched", 2);
    searched.shape.emplace_back();
    rich_ = log_.add(searched, log_.normal(2));
    Effect moved = law("moved");
    moved.transform.robot = [](Robot&, int, const Eigen::VectorXd&) {};
    moved_ = log_.add(moved, log_.normal(1));
    log_.add_noise();
    fits_.emplace(log_.fits());
    contenders_.emplace(*fits_, log_.masses(), log_.candidates());
  }

  [[nodiscard]] const std::vector<Eigen::Index>& columns(std::size_t k) {
    return log_.candidates()[k].term.columns;
  }

  Planted log_;
  std::size_t first_ = 0, second_ = 0, group_ = 0, rich_ = 0, moved_ = 0;
  std::optional<BlockFits> fits_;
  std::optional<Contenders> contenders_;
};

TEST_F(OfThem, TermsAreMassesAndThenWhatIsChosenInOrder) {
  const std::vector<Term> terms = contenders_->terms({rich_, first_}, moved_);
  ASSERT_EQ(terms.size(), 4U);
  EXPECT_EQ(terms[0].columns, log_.masses().columns);
  EXPECT_EQ(terms[1].columns, columns(rich_));
  EXPECT_EQ(terms[2].columns, columns(first_));
  EXPECT_EQ(terms[3].columns, columns(moved_));
  EXPECT_EQ(contenders_->terms({rich_, first_}).size(), 3U);
}

TEST_F(OfThem, TheLastOnesPartOfAFitIsThatOfItsColumns) {
  const Fit fit = fits_->fit(contenders_->terms({first_}, rich_));
  const Fit own = contenders_->last_of(rich_, fit);
  EXPECT_EQ(own.value, fit.value.tail(2));
  EXPECT_EQ(own.standard_error, fit.standard_error.tail(2));
  EXPECT_EQ(own.between_blocks, fit.between_blocks.tail(2));
  EXPECT_EQ(own.left, fit.left);
  EXPECT_EQ(part_of(fit, contenders_->first_column(), 1).value[0],
            fit.value[contenders_->first_column()]);
}

TEST_F(OfThem, GroupsAddNoParametersAndAreTakenWithAMember) {
  EXPECT_EQ(contenders_->parameters(), 5.0);
  EXPECT_TRUE(contenders_->is_among(group_, {second_}));
  EXPECT_FALSE(contenders_->is_among(group_, {rich_}));
  EXPECT_FALSE(contenders_->is_among(first_, {second_}));
  EXPECT_FALSE(contenders_->is_taken(first_, {second_}));  // the same law at another joint
}

TEST_F(OfThem, ShapeAndTransformationsCountOnTopOfParameters) {
  EXPECT_EQ(contenders_->cost(first_), 1U);
  EXPECT_EQ(contenders_->cost(group_), 2U);
  EXPECT_EQ(contenders_->cost(rich_), 3U);
  EXPECT_EQ(contenders_->cost(moved_), 2U);
  EXPECT_EQ(contenders_->cost({first_, rich_, moved_}), 6U);
  // Fewer findings are simpler, whatever they cost; of as many the cheaper.
  EXPECT_LT(contenders_->extent({rich_}), contenders_->extent({first_, second_}));
  EXPECT_LT(contenders_->extent({first_}), contenders_->extent({moved_}));
}

TEST(Contenders, TheMostPromisingIsFirstAndWhatIsExcludedIsNotThere) {
  Planted log(12);
  std::array<std::size_t, 5> k = {};
  for (std::size_t i = 0; i < k.size(); ++i) {
    k.at(i) = log.add(law(fmt::format("law{}", i)), log.normal(1));
  }
  log.plant(k[2], one_number(Planted::size_of(40.0)));
  log.plant(k[4], one_number(Planted::size_of(20.0)));
  log.add_noise();
  const BlockFits fits = log.fits();
  const Contenders contenders(fits, log.masses(), log.candidates());
  const Shortlist all = contenders.shortlist({}, 5);
  ASSERT_EQ(all.listed.size(), 5U);
  EXPECT_EQ(all.listed[0], k[2]);
  EXPECT_EQ(all.listed[1], k[4]);
  EXPECT_EQ(contenders.shortlist({}, 2).listed, (Chosen{k[2], k[4]}));
  EXPECT_EQ(contenders.shortlist({k[2]}, 1).listed, Chosen{k[4]});
  EXPECT_EQ(contenders.shortlist({}, 1, {k[2]}).listed, Chosen{k[4]});
}

/// A load that came at some moment shows at all moments near it: two of them are enough.
TEST(Contenders, MomentsOfOneLoadDoNotCrowdOutWhatIsSomethingElse) {
  Planted log(13);
  const Eigen::MatrixXd load = log.normal(1);
  std::vector<std::size_t> onsets;
  for (const std::size_t block : {6U, 8U, 10U, 12U, 14U}) {
    onsets.push_back(log.add(law("load"), load, 3, block));
  }
  const std::size_t elsewhere = log.add(law("load"), log.normal(1), 4, 10);
  const std::size_t other = log.add(law("other"), log.normal(1));
  log.plant(onsets[2], one_number(Planted::size_of(60.0)));
  log.plant(other, one_number(Planted::size_of(8.0)));
  log.add_noise();
  const BlockFits fits = log.fits();
  const Contenders contenders(fits, log.masses(), log.candidates());
  const Shortlist list = contenders.shortlist({}, 4);
  ASSERT_EQ(list.listed.size(), 4U);
  EXPECT_EQ(list.listed[0], onsets[2]);
  EXPECT_EQ(list.listed[2], other);
  EXPECT_EQ(list.listed[3], elsewhere);
  // With one moment taken no other is looked at.
  EXPECT_TRUE(contenders.is_taken(onsets[0], {onsets[2]}));
  EXPECT_EQ(contenders.shortlist({onsets[2]}, 4).listed, (Chosen{other, elsewhere}));
  // What came since a reference log is another place, and the same law.
  log.candidates()[onsets[0]].effect.when = When::since_reference;
  EXPECT_FALSE(contenders.is_taken(onsets[0], {onsets[2]}));
  EXPECT_TRUE(contenders.same_law(onsets[0], onsets[2]));
  EXPECT_FALSE(contenders.same_law(onsets[2], elsewhere));
}

TEST(Contenders, WhatTheOthersContainIsHidden) {
  Planted log(14);
  const Eigen::MatrixXd a = log.normal(1);
  const std::size_t one = log.add(law("one"), a), same = log.add(law("same"), -2.0 * a);
  const std::size_t near = log.add(law("near"), a + 0.05 * log.normal(1));
  log.add_noise();
  const BlockFits fits = log.fits();
  const Contenders contenders(fits, log.masses(), log.candidates());
  EXPECT_TRUE(contenders.shortlist({}, 5).hidden.empty());
  const Shortlist beside = contenders.shortlist({one}, 5);
  EXPECT_EQ(beside.hidden, Chosen{same});
  EXPECT_EQ(beside.listed, Chosen{near});
  const Contenders all(fits, log.masses(), log.candidates(), true);
  const Shortlist with_hidden = all.shortlist({one}, 5);
  EXPECT_EQ(with_hidden.hidden, Chosen{same});
  EXPECT_EQ(with_hidden.listed, (Chosen{near, same}));
}

/// A law with the width of another at its joint is looked at beside what was found, and is nothing
/// else: not sought, not in the usual fit, and no number that chance could have had more of.
TEST(Contenders, WhatIsOnlyARivalIsNotSought) {
  Planted log(15);
  Effect usual = law("usual");
  usual.is_usual = true;
  const Eigen::MatrixXd column = log.normal(1);
  const std::size_t sought = log.add(usual, column, 0);
  const std::size_t rival = log.add(usual, column + 0.1 * log.normal(1), 1);
  const std::size_t other = log.add(law("other"), log.normal(1), 2);
  log.plant(rival, one_number(Planted::size_of(40.0)));
  log.add_noise();
  const BlockFits fits = log.fits();
  const Contenders contenders(fits, log.masses(), log.candidates());
  EXPECT_EQ(contenders.shortlist({}, 1).listed, Chosen{rival});
  EXPECT_EQ(contenders.usual(), (Chosen{sought, rival}));
  EXPECT_EQ(contenders.parameters(), 3.0);
  log.candidates()[rival].only_rival = true;
  EXPECT_EQ(contenders.shortlist({}, 5).listed.front(), sought);
  EXPECT_EQ(contenders.shortlist({}, 5).listed.size(), 2U);
  EXPECT_EQ(contenders.rivals({}, 1), Chosen{rival});
  EXPECT_EQ(contenders.rivals({other}, 5), (Chosen{rival, sought}));
  EXPECT_EQ(contenders.usual(), Chosen{sought});
  EXPECT_EQ(contenders.parameters(), 2.0);
}

}  // namespace
}  // namespace shapeid::diagnosis
