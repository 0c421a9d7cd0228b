// Updates of a factorisation against fits of each set by itself.
#include "shapeid/diagnosis/fits_around.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::effect;
using test::record;

/// Sums of a log with all hypotheses, columns that nearly coincide among them.
Tally sums() {
  const Robot robot = arm();
  const Recording log = record({{effect("viscous_friction", 1, {0.3})}});
  Tally tally = empty_tally(robot, all_hypotheses(robot));
  TallyOptions options;
  options.weight = Eigen::Vector3d(1.0, 4.0, 9.0);
  options.block_seconds = 0.5;
  add_to_tally(tally, robot, ContactTreatment::ignore, RichModel{stacked_parameters(robot), {}},
               log, options, false);
  return tally;
}

BlockFits fits(Tally tally) {
  return {std::move(tally), stacked_parameters(arm()), Eigen::VectorXd::Constant(40, 0.3), 8};
}

/// The same of a log from which `value` times a column was taken.
Tally less(Tally tally, Eigen::Index column, double value) {
  const Eigen::Index F = tally.columns();
  for (Block& block : tally.blocks) {
    Eigen::MatrixXd& G = block.sums;
    G.col(F) -= value * G.col(column);
    G.row(F) -= value * G.row(column);
  }
  return tally;
}

Term masses() {
  Term term{"masses", {}, {}, 0};
  for (Eigen::Index p = 10; p < 40; ++p) term.columns.push_back(p);
  return term;
}

std::vector<Term> hypotheses_as_terms(const BlockFits& fits) {
  const Tally& tally = fits.tally();
  std::vector<Term> list;
  for (std::size_t k = 0; k < tally.hypotheses.size(); ++k) {
    Term& term = list.emplace_back();
    // Every third one begins later, every fifth ends earlier.
    term.from_block = k % 3 == 0 ? 7 : 0;
    if (k % 5 == 0) term.to_block = 20;
    for (Eigen::Index p = 0; p < tally.hypotheses[k].value.size(); ++p) {
      term.columns.push_back(tally.first[k] + p);
    }
  }
  return list;
}

/// Largest difference over the errors' size, eps and how badly the normal matrix may be
/// conditioned: its least eigenvalue is the regularity of the fits, 1e-10.
double scaled(const Eigen::VectorXd& one, const Eigen::VectorXd& other) {
  constexpr double condition = 1e10;
  return (one - other).cwiseAbs().maxCoeff() /
         (other.maxCoeff() * condition * std::numeric_limits<double>::epsilon());
}
constexpr double threshold = 1.0;

class Around : public ::testing::Test {
 protected:
  BlockFits fits_ = fits(sums());
  std::vector<Term> hypotheses_ = hypotheses_as_terms(fits_);

  /// Masses and every `stride`th hypothesis.
  [[nodiscard]] std::vector<Term> some(std::size_t stride) const {
    std::vector<Term> list = {masses()};
    for (std::size_t k = 1; k < hypotheses_.size(); k += stride) list.push_back(hypotheses_[k]);
    return list;
  }
};

TEST_F(Around, TheSetItselfIsThatOfOneFit) {
  EXPECT_EQ(FitsAround(fits_, some(3)).error().size(), fits_.blocks());
  EXPECT_LT(scaled(FitsAround(fits_, some(3)).error(), fits_.held_out(some(3))), threshold);
  EXPECT_LT(scaled(FitsAround(fits_, {masses()}).error(), fits_.held_out({masses()})), threshold);
}

TEST_F(Around, OneTermLess) {
  const std::vector<Term> terms = some(4);
  const FitsAround around(fits_, terms);
  for (std::size_t i = 0; i < terms.size(); ++i) {
    std::vector<Term> fewer = terms;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_LT(scaled(around.without(i), fits_.held_out(fewer)), threshold) << i;
  }
}

TEST_F(Around, OneTermMore) {
  const std::vector<Term> terms = some(5);
  const FitsAround around(fits_, terms);
  for (std::size_t k = 0; k < hypotheses_.size(); ++k) {
    std::vector<Term> more = terms;
    more.push_back(hypotheses_[k]);
    EXPECT_LT(scaled(around.with(hypotheses_[k]), fits_.held_out(more)), threshold) << k;
  }
}

/// As on a log from which the fixed part was taken.
TEST_F(Around, OneTermFixed) {
  const std::vector<Term> terms = {masses(), hypotheses_[1], hypotheses_[4]};
  ASSERT_EQ(terms[1].columns.size(), 1U);
  const FitsAround around(fits_, terms);
  EXPECT_EQ(around.fixed_at(1, Eigen::VectorXd::Zero(1)), around.without(1));
  for (const double value : {-0.4, 0.02, 1.5}) {
    const BlockFits moved = fits(less(sums(), terms[1].columns[0], value));
    EXPECT_LT(scaled(around.fixed_at(1, Eigen::VectorXd::Constant(1, value)),
                     moved.held_out({terms[0], terms[2]})),
              threshold);
  }
}

/// What the fit of a log from which the columns were taken loses.
TEST_F(Around, NumbersMoveAsAnotherRises) {
  const std::vector<Term> terms = {masses(), hypotheses_[1]};
  const Eigen::VectorXd before = fits_.fit(terms).value;
  const std::vector<Eigen::MatrixXd> moves = fits_.moves(terms, hypotheses_);
  const Tally whole = sums();
  ASSERT_EQ(moves.size(), hypotheses_.size());
  for (std::size_t k = 2; k < hypotheses_.size(); ++k) {
    // These are taken from a part of the log alone.
    if (hypotheses_[k].from_block > 0 || k % 5 == 0) continue;
    for (Eigen::Index p = 0; p < moves[k].cols(); ++p) {
      constexpr double value = 0.7;
      const Eigen::Index column = hypotheses_[k].columns[static_cast<std::size_t>(p)];
      const Eigen::VectorXd after = fits(less(whole, column, value)).fit(terms).value;
      const Eigen::VectorXd wanted = before - value * moves[k].col(p);
      // Both shifted so that the scale is that of the largest number.
      const Eigen::VectorXd large =
          Eigen::VectorXd::Constant(wanted.size(), wanted.cwiseAbs().maxCoeff());
      EXPECT_LT(scaled(after - wanted + large, large), threshold) << k;
    }
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
