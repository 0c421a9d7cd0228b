// Equations (7)-(9): the projection's own laws, on Jacobians of robots, whole and losing rank.
#include "shapeid/reference/projection.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/touching.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using reference::contact_free_basis;
using reference::contact_jacobian;
using test::few_hundred_eps;
using test::scaled;

/// No arm of our robots and no weight makes as much; counting rounding to the rank makes a million
/// times more.
constexpr double largest_condition = 1e8;

/// The range of A by singular values, which share nothing with the QR but the rank that it decided.
struct Range {
  MatrixXd basis;          ///< orthonormal
  double left_out = 0.0;   ///< the largest singular value beyond the rank
  double condition = 1.0;  ///< largest over smallest singular value within the rank
};

Range range_by_svd(const MatrixXd& A, int rank) {
  if (A.size() == 0) return {MatrixXd(A.rows(), 0)};
  const test::ThinSvd svd(A);
  const VectorXd& sigma = svd.sigma;
  Range range{svd.U.leftCols(rank)};
  if (rank < sigma.size()) range.left_out = sigma[rank];
  if (rank > 0) range.condition = sigma[0] / sigma[rank - 1];
  return range;
}

RC_GTEST_PROP(ContactFreeBasis, NoContactForceSurvives, ()) {
  const auto [robot, s] = *test::robot_in_contact();
  const MatrixXd J = contact_jacobian(robot, s);
  const VectorXd weight = *test::weights(robot.dof());
  const auto [Q2, rank] = contact_free_basis(J, weight);
  const MatrixXd forces_in_rows = weight.cwiseSqrt().asDiagonal() * J.transpose();

  RC_ASSERT(Q2.rows() == robot.dof());
  RC_ASSERT(Q2.cols() == robot.dof() - rank);
  RC_ASSERT(scaled((Q2.transpose() * forces_in_rows).norm(), forces_in_rows.norm(), Q2.rows()) <
            few_hundred_eps);
  RC_ASSERT(scaled((Q2.transpose() * Q2 - MatrixXd::Identity(Q2.cols(), Q2.cols())).norm(), 1.0,
                   Q2.rows()) < few_hundred_eps);
}

// Q2 itself is only defined up to a rotation; the projector on its span is not. By another
// decomposition: I - A A^+, and A A^+ = U1 U1^T with the left singular vectors that count.
RC_GTEST_PROP(ContactFreeBasis, SpansWhatThePseudoInverseLeaves, ()) {
  const auto [robot, s] = *test::robot_in_contact();
  const MatrixXd J = contact_jacobian(robot, s);
  const VectorXd weight = *test::weights(robot.dof());
  const auto [Q2, rank] = contact_free_basis(J, weight);

  const MatrixXd A = weight.cwiseSqrt().asDiagonal() * J.transpose();
  const Range range = range_by_svd(A, rank);
  const MatrixXd left =
      MatrixXd::Identity(A.rows(), A.rows()) - range.basis * range.basis.transpose();

  // What the rank leaves out is rounding, what it counts is not, and a range is as well defined as
  // its condition.
  RC_ASSERT(range.condition < largest_condition);
  RC_ASSERT(scaled(range.left_out, A.norm(), A.rows()) < few_hundred_eps);
  RC_ASSERT(scaled((Q2 * Q2.transpose() - left).norm(), range.condition, A.rows()) <
            few_hundred_eps);
}

TEST(ContactFreeBasis, WithoutContactIsTheIdentity) {
  const auto [Q2, rank] = contact_free_basis(MatrixXd(0, 9), VectorXd::Constant(9, 4.0));
  EXPECT_EQ(rank, 0);
  EXPECT_EQ(Q2, MatrixXd::Identity(9, 9));
}

TEST(ContactFreeBasis, ContactThatMovesNothingTakesNoRow) {
  const auto [Q2, rank] = contact_free_basis(MatrixXd::Zero(3, 4), VectorXd::Ones(4));
  EXPECT_EQ(rank, 0);
  EXPECT_EQ(Q2.cols(), 4);
}

/// Rank of J^T of a robot with these contacts, all touching.
int rank_of(const Robot& robot, Sample s) {
  s.in_contact.assign(robot.contacts.size(), true);
  return contact_free_basis(contact_jacobian(robot, s), VectorXd::Ones(robot.dof())).rank;
}

TEST(Rank, StretchedLegOfAFixedBaseLosesOne) {
  EXPECT_EQ(rank_of(test::leg(Root::fixed), test::posture(0.3, -0.8)), 2);
  EXPECT_EQ(rank_of(test::leg(Root::fixed), test::posture(0.3, 0.0)), 1);
  // sin(pi) is not zero in double arithmetic: a folded leg is singular to rounding only.
  EXPECT_EQ(rank_of(test::leg(Root::fixed), test::posture(0.3, std::numbers::pi)), 1);
}

TEST(Rank, StretchedLegOfAFloatingBaseLosesNothing) {
  EXPECT_EQ(rank_of(test::leg(Root::floating), test::posture(0.3, -0.8)), 3);
  EXPECT_EQ(rank_of(test::leg(Root::floating), test::posture(0.3, 0.0)), 3);
}

/// A floating base, something of it that touches, and so many legs of three joints whose feet do.
Robot walker(int legs, ContactKind of_base) {
  Robot robot;
  robot.links.resize(1);
  Contact belly;
  belly.kind = of_base;
  belly.frame = Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.6, 0.0, 0.8));
  belly.frame.translation() << 0.05, -0.02, -0.08;
  robot.contacts = {belly};
  for (int leg = 0; leg < legs; ++leg) {
    const double x = leg % 2 == 0 ? 0.25 : -0.23, y = leg < 2 ? 0.12 : -0.13;
    for (const auto& [axis, place] :
         {std::pair(Eigen::Vector3d::UnitX(), Eigen::Vector3d(x, y, 0.02)),
          std::pair(Eigen::Vector3d::UnitY(), Eigen::Vector3d(0.01, 0.06, -0.03)),
          std::pair(Eigen::Vector3d::UnitY(), Eigen::Vector3d(0.0, 0.01, -0.35))}) {
      const int parent = robot.link_count() == 3 * leg + 1 ? 0 : robot.link_count() - 1;
      Link& link = robot.links.emplace_back();
      link.parent = parent;
      link.joint.axis = axis;
      link.joint.placement.translation() = place;
    }
    Contact foot;
    foot.link = robot.link_count() - 1;
    foot.frame.translation() << 0.0, 0.03, -0.31;
    robot.contacts.push_back(foot);
  }
  return robot;
}

/// Knees bent and hips below the base: every leg can move its foot in three directions.
Sample crouching(int legs) {
  Sample s;
  s.q.resize(Eigen::Index{3} * legs);
  for (int leg = 0; leg < legs; ++leg) {
    s.q.segment<3>(Eigen::Index{3} * leg) << *test::real(-0.5, 0.5), *test::real(-0.5, 0.5),
        *test::real(0.7, 1.4);
  }
  s.dq = s.ddq = s.tau = VectorXd::Zero(Eigen::Index{3} * legs);
  return s;
}

// What touches the base asks for the base alone, each foot for its own leg: these are independent,
// whatever the weights. Contacts that are named again add nothing.
RC_GTEST_PROP(Rank, IsThatOfTheContactsWithoutTheirRepetitions, ()) {
  const int legs = *rc::gen::inRange(1, 5);
  const auto kind = *rc::gen::element(ContactKind::point, ContactKind::line, ContactKind::plane);
  Robot robot = walker(legs, kind);
  Sample s = crouching(legs);
  const auto rank = static_cast<int>(force_numbers(kind)) + 3 * legs;
  const auto repeated = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, legs + 1));
  for (const int c : repeated) {
    robot.contacts.push_back(robot.contacts[static_cast<std::size_t>(c)]);
  }
  s.in_contact.assign(robot.contacts.size(), true);
  const VectorXd weight = *test::weights(robot.dof());
  const MatrixXd J = contact_jacobian(robot, s);
  const MatrixXd A = weight.cwiseSqrt().asDiagonal() * J.transpose();
  RC_ASSERT(range_by_svd(A, rank).condition < largest_condition);
  RC_ASSERT(contact_free_basis(J, weight).rank == rank);
  const VectorXd F = *test::vector(robot.dof(), 100.0);
  RC_ASSERT(reference::eliminate_contacts(F, F, J, weight).rank == rank);
}

TEST(Rank, ContactNamedTwiceCountsOnce) {
  Robot robot = test::leg(Root::floating);
  robot.contacts.push_back(robot.contacts.front());
  EXPECT_EQ(rank_of(robot, test::posture(0.3, -0.8)), 3);
}

// Forces at two points of one body cannot turn it about the line between them; at three they can,
// and a fourth adds nothing.
TEST(Rank, PointsOnOneLinkMakeALineThenAPlane) {
  Robot robot = test::leg(Root::floating);
  const Contact foot = robot.contacts.front();
  const auto rank_with = [&](double x, double y) {
    robot.contacts.push_back(foot);
    robot.contacts.back().frame.translation() += Eigen::Vector3d(x, y, 0.0);
    return rank_of(robot, test::posture(0.3, -0.8));
  };
  EXPECT_EQ(rank_with(0.1, 0.0), 5);
  EXPECT_EQ(rank_with(0.0, 0.05), 6);
  EXPECT_EQ(rank_with(0.1, 0.05), 6);
  robot.contacts.push_back(foot);
  robot.contacts.back().kind = ContactKind::plane;
  EXPECT_EQ(rank_of(robot, test::posture(0.3, -0.8)), 6);
}

// Forces counted in another order and other units have another Q2, and the same normal equations.
RC_GTEST_PROP(EliminateContacts, BasisOfTheForcesDoesNotMatter, ()) {
  const auto [robot, s] = *test::robot_in_contact();
  const MatrixXd J = contact_jacobian(robot, s);
  const VectorXd weight = *test::weights(robot.dof());
  const MatrixXd Y = reference::regressor(robot, s);
  const MatrixXd other_J =
      VectorXd::LinSpaced(J.rows(), 0.5, 2.0).asDiagonal() * J.colwise().reverse();

  const VectorXd F = *test::vector(robot.dof(), 100.0);
  const auto one = reference::eliminate_contacts(Y, F, J, weight);
  const auto other = reference::eliminate_contacts(Y, F, other_J, weight);
  RC_ASSERT(one.rank == other.rank);

  const VectorXd root = weight.cwiseSqrt();
  const MatrixXd A = root.asDiagonal() * J.transpose();
  const double condition = range_by_svd(A, one.rank).condition;
  const auto residual = [&](const MatrixXd& error, const MatrixXd& a, const MatrixXd& b) {
    return scaled(error.norm(),
                  condition * (root.asDiagonal() * a).norm() * (root.asDiagonal() * b).norm(),
                  A.rows());
  };
  RC_ASSERT(residual(one.Y.transpose() * one.Y - other.Y.transpose() * other.Y, Y, Y) <
            few_hundred_eps);
  RC_ASSERT(residual(one.Y.transpose() * one.F - other.Y.transpose() * other.F, Y, F) <
            few_hundred_eps);
}

RC_GTEST_PROP(EliminateContacts, ObjectiveIsTheMinimumOverForces, ()) {
  const auto [robot, s] = *test::robot_in_contact();
  const MatrixXd J = contact_jacobian(robot, s);
  const VectorXd weight = *test::weights(robot.dof());
  const VectorXd residual = *test::vector(robot.dof(), 100.0);
  const reference::ContactFreeRows free =
      reference::eliminate_contacts(residual, VectorXd::Zero(robot.dof()), J, weight);

  // min over f of || W^(1/2) (residual - J^T f) || by singular values.
  const VectorXd root = weight.cwiseSqrt();
  const MatrixXd A = root.asDiagonal() * J.transpose();
  const VectorXd r = root.asDiagonal() * residual;
  const Range range = range_by_svd(A, free.rank);
  const double least = (r - range.basis * (range.basis.transpose() * r)).norm();
  RC_ASSERT(scaled(std::abs(free.Y.norm() - least), range.condition * r.norm(), A.rows()) <
            few_hundred_eps);
}

// Levers are metres: a picometre is none, nor are as many digits of longer ones, whatever the
// weights.
TEST(ContactFreeBasis, ALeverBelowAPicometreIsNone) {
  for (const double weight : {1.0, 1e-4, 1e4}) {
    const VectorXd weights = VectorXd::Constant(8, weight);
    const auto rank = [&](double first, double second) {
      MatrixXd J = MatrixXd::Zero(2, 8);
      J(0, 2) = first;
      J(1, 5) = second;
      return contact_free_basis(J, weights).rank;
    };
    EXPECT_EQ(rank(0.3, 0.3), 2);
    EXPECT_EQ(rank(0.3, 2e-12), 2);
    EXPECT_EQ(rank(0.3, 0.5e-12), 1);
    EXPECT_EQ(rank(0.0, 0.5e-12), 0);
    EXPECT_EQ(rank(1e3, 2e-9), 2);
    EXPECT_EQ(rank(1e3, 0.5e-9), 1);
  }
}

}  // namespace
}  // namespace shapeid
