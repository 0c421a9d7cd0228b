// fast::ContactElimination against reference::eliminate_contacts, on matrices of any shape and
// rank.
#include "shapeid/fast/projection.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "shapeid/reference/projection.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fast::ContactElimination;

MatrixXd matrix(Index rows, Index columns) {
  MatrixXd result(rows, columns);
  result.reshaped() = *test::vector(rows * columns, 1.0);
  return result;
}

/// forces x dof, of a rank that is drawn; nothing is left of a matrix of rank zero.
MatrixXd any_jacobian(Index forces, Index dof) {
  const Index rank = *rc::gen::inRange<Index>(0, std::min(forces, dof) + 1);
  return matrix(forces, rank) * matrix(rank, dof);
}

/// Largest over smallest singular value that counts, of W^(1/2) J^T.
double condition(const MatrixXd& J, const VectorXd& weight, int rank) {
  if (rank == 0) return 1.0;
  const MatrixXd A = weight.cwiseSqrt().asDiagonal() * J.transpose();
  const VectorXd sigma = test::singular_values(A);
  return std::max(sigma[0], weight.cwiseSqrt().maxCoeff()) / sigma[rank - 1];
}

RC_GTEST_PROP(FastContactElimination, AsTheReference, ()) {
  const Index rows = *rc::gen::inRange<Index>(1, 20), forces = *rc::gen::inRange<Index>(0, 13);
  const Index unknowns = *rc::gen::inRange<Index>(0, 12);
  VectorXd weight(rows);
  for (double& w : weight) w = *test::magnitude(1e-2, 1e2);
  ContactElimination eliminate(weight, forces);
  for (int k = 0; k < 2; ++k) {  // nothing of an earlier call stays
    const MatrixXd J = any_jacobian(forces, rows), Y = matrix(rows, unknowns);
    const VectorXd F = matrix(rows, 1);
    const auto expected = reference::eliminate_contacts(Y, F, J, weight);
    MatrixXd YF(rows, unknowns + 1), free(rows - expected.rank, unknowns + 1);
    YF << Y, F;
    free << expected.Y, expected.F;
    const double scale =
        condition(J, weight, expected.rank) * (weight.cwiseSqrt().asDiagonal() * YF).squaredNorm();

    const Index rank = eliminate(J.transpose().eval(), YF);
    RC_ASSERT(rank == expected.rank);
    const auto ours = YF.bottomRows(rows - rank);
    RC_ASSERT(test::scaled((ours.transpose() * ours - free.transpose() * free).norm(),
                           scale > 0.0 ? scale : 1.0, rows) < test::few_hundred_eps);
  }
}

TEST(FastContactElimination, WithoutForcesOnlyWeighs) {
  ContactElimination eliminate(VectorXd::Constant(5, 4.0), 3);
  MatrixXd rows = MatrixXd::Ones(5, 2);
  EXPECT_EQ(eliminate(MatrixXd(5, 0), rows), 0);
  EXPECT_EQ(rows, MatrixXd::Constant(5, 2, 2.0));
}

// A lever of less than a picometre is rounding, and takes no row; one of a little more is a lever.
TEST(FastContactElimination, KeepsTheReferencesRankRule) {
  for (const auto& [lever, rank] : {std::pair(0.9e-12, 1), std::pair(1.1e-12, 2)}) {
    MatrixXd J = MatrixXd::Zero(2, 4);
    J(0, 1) = 1.0;
    J(1, 3) = lever;
    ContactElimination eliminate(VectorXd::Ones(4), 2);
    MatrixXd rows = MatrixXd::Ones(4, 2);
    EXPECT_EQ(eliminate(J.transpose().eval(), rows), rank);
    EXPECT_EQ(reference::contact_free_basis(J, VectorXd::Ones(4)).rank, rank);
  }
}

}  // namespace
}  // namespace shapeid
