// Sums of rows by blocks.
#include "shapeid/diagnosis/tally.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shapeid/diagnosis/series.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::diagnosis {
namespace {

/// The squares that the sums promise for any numbers of the hypotheses are those that predictions
/// with these numbers leave. Rows of a joint have entries in few columns, others in other ones.
TEST(Tally, ItsSumsAreTheSquaresThatPredictionsLeave) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  const std::vector<AppliedEffect> effects = {test::effect("coulomb_friction", 0, {0.2}),
                                              test::effect("viscous_friction", 1, {0.3}),
                                              test::effect("torque_offset", 2, {-0.4}),
                                              test::effect("load_friction", 1, {0.05}),
                                              test::effect("stribeck_friction", 2, {0.15}),
                                              test::effect("external_force", 2, {1.0, -2.0, 3.0})};
  const RichModel rigid{stacked_parameters(robot), {}};
  std::vector<AppliedEffect> hypotheses = effects;
  for (AppliedEffect& h : hypotheses) h.value.setZero();
  Tally tally = empty_tally(robot, hypotheses);
  TallyOptions options;
  options.stride = 1;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  options.margin = 0.0;
  options.block_seconds = log.duration() / 4.0;
  add_to_tally(tally, robot, ContactTreatment::ignore, rigid, log, options, false);

  Eigen::VectorXd x = Eigen::VectorXd::Zero(tally.width);
  x.head(tally.inertial) = rigid.Phi;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    x.segment(tally.first[k], effects[k].value.size()) = effects[k].value;
  }
  x[tally.width - 1] = -1.0;
  double promised = 0.0, terms = 0.0;
  for (const Block& block : tally.blocks) {
    promised += x.dot(block.sums * x);
    terms += x.cwiseAbs().dot(block.sums.cwiseAbs() * x.cwiseAbs());
    EXPECT_EQ(block.sums, Eigen::MatrixXd(block.sums.transpose()));
  }
  const Series left = series(robot, ContactTreatment::ignore, {rigid.Phi, effects}, log, 1);
  EXPECT_GT(promised, 1.0) << "the log has none of these effects";
  const double off = std::abs(promised - left.residual.squaredNorm());
  EXPECT_LT(test::scaled(off, terms, left.residual.size()), test::few_hundred_eps);
}

/// Of the same log, as though the others had not been asked for.
TEST(Tally, OfTheFirstHypothesesHasTheSumsOfThese) {
  const Robot robot = test::arm();
  const Recording log = test::record({});
  const RichModel rigid{stacked_parameters(robot), {}};
  TallyOptions options;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  options.block_seconds = log.duration() / 3.0;
  const std::vector<AppliedEffect> two = {test::effect("external_force", 1, {0.0, 0.0, 0.0}),
                                          test::effect("viscous_friction", 2, {0.0})};
  std::vector<AppliedEffect> three = two;
  three.push_back(test::effect("encoder_offset", 1, {0.0}));
  Tally few = empty_tally(robot, two);
  Tally all = empty_tally(robot, three, {{.hypothesis = 1, .signal = Signal::position}});
  for (Tally* tally : {&few, &all}) {
    add_to_tally(*tally, robot, ContactTreatment::ignore, rigid, log, options, false);
  }
  const Tally first = with_first(all, 2);
  EXPECT_EQ(first.width, few.width);
  EXPECT_EQ(first.first, few.first);
  EXPECT_TRUE(first.modulations.empty() && first.first_modulated.empty());
  ASSERT_EQ(first.blocks.size(), few.blocks.size());
  for (std::size_t b = 0; b < few.blocks.size(); ++b) {
    EXPECT_LT(test::scaled_difference(first.blocks[b].sums, few.blocks[b].sums, 1000),
              test::few_hundred_eps);
  }
}

}  // namespace
}  // namespace shapeid::diagnosis
