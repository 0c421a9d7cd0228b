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

}  // namespace
}  // namespace shapeid::diagnosis
