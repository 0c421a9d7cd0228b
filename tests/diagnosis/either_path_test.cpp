// The diagnosis by the fast path against the diagnosis by the reference.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "shapeid/diagnosis/consistent.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/hypotheses.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/diagnosis/rigid_rows.hpp"
#include "shapeid/diagnosis/shape_masses.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/diagnosis/arm.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::diagnosis {
namespace {

using test::arm;
using test::arm_settings;
using test::effect;
using test::few_hundred_eps;
using test::found_ids;
using test::record;
using test::scaled;

/// Largest over smallest singular value, of those that are no rounding.
double condition(const Eigen::MatrixXd& J) {
  if (J.size() == 0) return 1.0;
  const test::ThinSvd svd(J);
  return svd.rank() == 0 ? 1.0 : svd.sigma[0] / svd.sigma[svd.rank() - 1];
}

RC_GTEST_PROP(EitherPath, HasTheSameRowsBeyondContacts, ()) {
  const Root root = *rc::gen::element(Root::fixed, Root::floating);
  const Robot robot = *test::robot({2, 8, root});
  const Sample sample = *test::sample(robot);
  const auto motions = reference::link_motions(robot, sample);
  RigidRows one(robot, Path::reference), other(robot, Path::fast);
  const Eigen::MatrixXd Y = one.regressor(robot, sample, motions),
                        J = one.contact_jacobian(robot, sample, motions);
  const Eigen::MatrixXd Y2 = other.regressor(robot, sample, motions),
                        J2 = other.contact_jacobian(robot, sample, motions);
  RC_ASSERT(Y2.rows() == Y.rows() && Y2.cols() == Y.cols());
  RC_ASSERT(J2.rows() == J.rows() && J2.cols() == J.cols());
  RC_ASSERT(scaled((Y2 - Y).norm(), 1.0 + Y.norm(), robot.link_count()) < few_hundred_eps);
  RC_ASSERT(scaled((J2 - J).norm(), 1.0 + J.norm(), robot.link_count()) < few_hundred_eps);

  const Eigen::VectorXd weight = (*test::vector(robot.dof(), 1.0)).array().exp();
  const double k = condition(weight.cwiseSqrt().asDiagonal() * J.transpose());
  RC_PRE(k < 1e6);  // beyond, what counts as rank is decided by the last digits
  ContactFree free_one(robot, weight, Path::reference), free_other(robot, weight, Path::fast);
  const Eigen::MatrixXd A = free_one(J, Y), B = free_other(J, Y);
  RC_ASSERT(A.rows() == B.rows());
  // Up to a rotation: the sums of squares are what the fits see.
  const Eigen::MatrixXd G = A.transpose() * A;
  const double size = weight.maxCoeff() * Y.squaredNorm();
  RC_ASSERT(scaled((B.transpose() * B - G).norm(), k * (1.0 + size), robot.dof()) <
            few_hundred_eps);

  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(robot.dof());
  const double plain = condition(J);
  RC_PRE(plain < 1e6);
  ContactFree ones_one(robot, ones, Path::reference), ones_other(robot, ones, Path::fast);
  RC_ASSERT(scaled((ones_other.beyond(J, Y) - ones_one.beyond(J, Y)).norm(),
                   plain * (1.0 + Y.norm()), robot.dof()) < few_hundred_eps);
}

RC_GTEST_PROP(EitherPath, TakesTheSameForce, ()) {
  const Root root = *rc::gen::element(Root::fixed, Root::floating);
  const Robot robot = *test::robot({2, 8, root});
  // Let loose, the root feels all wrenches whole; a joint may feel a small part of a large one.
  Robot loose = robot;
  loose.root = Root::floating;
  RigidRows one(robot, Path::reference), other(robot, Path::fast);
  const Eigen::VectorXd first = *test::vector(10 * robot.link_count(), 2.0),
                        second = *test::vector(10 * robot.link_count(), 2.0);
  // Twice the same, then other numbers, then the first again: nothing of the earlier ones stays.
  for (const Eigen::VectorXd& Phi : {first, first, second, first}) {
    const Sample sample = *test::sample(robot);
    const auto motions = reference::link_motions(robot, sample);
    const Eigen::MatrixXd Y = one.regressor(robot, sample, motions);
    const double terms = reference::regressor(loose, motions).norm() * Phi.norm();
    RC_ASSERT(scaled((one.inverse_dynamics(robot, sample, motions, Phi) - Y * Phi).norm(), terms,
                     robot.link_count()) < few_hundred_eps);
    RC_ASSERT(scaled((other.inverse_dynamics(robot, sample, motions, Phi) - Y * Phi).norm(), terms,
                     robot.link_count()) < few_hundred_eps);
  }
}

/// The zero of a joint about the vertical changes nothing: neither path makes a column of rounding,
/// which would look as if it could be told from everything else.
TEST(EitherPath, WhatNoRowFeelsIsNoColumn) {
  const Recording log = record({{}, 4.0, 0.0});
  Robot robot = arm();
  Joint& first = robot.links[1].joint;
  first.kind = JointKind::revolute;
  first.axis = Eigen::Vector3d::UnitZ();
  first.placement.linear().setIdentity();
  const RichModel model{stacked_parameters(robot), {}};
  for (const Path path : {Path::reference, Path::fast}) {
    const HypothesisColumns columns(
        robot, {ContactTreatment::ignore, path}, model,
        {at_start(*find_effect("encoder_offset"), 0), at_start(*find_effect("encoder_offset"), 1)});
    double felt = 0.0;
    for (const std::size_t index : log.usable(50)) {
      const View view = columns.viewer().view(log, index);
      const Eigen::MatrixXd E =
          columns.at(log, index, view, predict(columns.viewer(), view, model));
      EXPECT_TRUE(E.col(0).isZero(0.0)) << E.col(0).transpose();
      felt += E.col(1).norm();
    }
    EXPECT_GT(felt, 0.1);
  }
}

/// Names, numbers and masses; the paths differ by rounding, which the loop's many fits and the
/// search for nonlinear numbers enlarge.
TEST(EitherPath, SaysTheSame) {
  const Recording log = record(
      {{effect("coulomb_friction", 1, {0.4}), effect("torque_delay", 0, {0.012})}, 20.0, 0.02});
  LoopSettings settings = arm_settings();
  const LoopResult one = close_loop(arm(), log, nullptr, settings);
  const Consistent bodies = make_consistent(arm(), log, nullptr, settings, one);
  settings.rows.path = Path::fast;
  const LoopResult other = close_loop(arm(), log, nullptr, settings);
  const Consistent other_bodies = make_consistent(arm(), log, nullptr, settings, other);
  ASSERT_FALSE(found_ids(one).empty());
  EXPECT_EQ(found_ids(one), found_ids(other));
  constexpr double enlarged = 1e-6;
  for (std::size_t k = 0; k < one.found.size(); ++k) {
    EXPECT_LT((one.found[k].effect.value - other.found[k].effect.value).norm(),
              enlarged * one.found[k].effect.value.norm());
  }
  EXPECT_LT((bodies.model.Phi - other_bodies.model.Phi).norm(), enlarged * bodies.model.Phi.norm());
  EXPECT_LT((bodies.Phi_error - other_bodies.Phi_error).norm(), enlarged * bodies.Phi_error.norm());
}

/// Rows of two links of the arm with noise, and what an expected mass makes of them.
struct Masses {
  BodyModel shapes = generous_regions(arm(), {2, 3});
  MassProblem problem;
  DivisionOptions options;

  explicit Masses(double size) {
    problem.Y = size * Eigen::MatrixXd::Random(60, 20);
    problem.F =
        problem.Y * stacked_parameters(arm()).tail(20) + 0.01 * size * Eigen::VectorXd::Random(60);
    problem.W = Eigen::VectorXd::Ones(60);
    problem.U = shape_columns(shapes);
    problem.V = shape_volumes(shapes);
    problem.lambda = default_lambda(problem, 3.0);
    problem.mass_bound = 30.0;
    options.most_divisions = 30;
    options.expected_mass = 3.0;
  }
  [[nodiscard]] ShapeMasses by(Path path) const { return {shapes, problem, options, path}; }
};

TEST(EitherPath, FindsTheSameMasses) {
  const Masses given(1.0);
  const ShapeMasses one = given.by(Path::reference), other = given.by(Path::fast);
  // Of one optimum (claim C13): rounding, enlarged by what the rows leave nearly open.
  constexpr double enlarged = 1e-6;
  EXPECT_LT((one.Phi() - other.Phi()).norm(), enlarged * one.Phi().norm());
  const Eigen::MatrixXd Y = given.problem.Y.topRows(50);
  const Eigen::VectorXd F = given.problem.F.head(50);
  const Eigen::VectorXd a = one.Phi_of(Y, F), b = other.Phi_of(Y, F);
  EXPECT_LT((a - b).norm(), enlarged * a.norm());
  EXPECT_GT((a - one.Phi()).norm(), 1e3 * enlarged * a.norm()) << "other rows, other masses";
}

TEST(EitherPath, IsRefusedWhereTheFastPathDeclines) {
  constexpr double large = 1e160;  // its square overflows
  const Masses given(1.0), too_large(large);
  EXPECT_THROW(static_cast<void>(too_large.by(Path::fast)), Refusal);
  const ShapeMasses masses = given.by(Path::fast);
  EXPECT_THROW(static_cast<void>(masses.Phi_of(large * given.problem.Y, given.problem.F)), Refusal);
  EXPECT_EQ(masses.Phi(), given.by(Path::fast).Phi()) << "and the masses so far are as they were";
}

}  // namespace
}  // namespace shapeid::diagnosis
