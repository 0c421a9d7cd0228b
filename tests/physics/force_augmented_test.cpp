// Equation (9) against the problem that it stands for: the sparse least squares in (Phi, f_1 ..
// f_N) with every contact force an unknown, by SuiteSparse's SPQR.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/projection.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/touching.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/spqr_oracle.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::few_hundred_eps;
using test::RowsWithForces;
using test::scaled;

/// The projected rows of all samples, one under the other. They begin with a row of zeros, which
/// says nothing: Eigen's SVD wants at least one row, and forces can reach every one of ours.
struct ProjectedRows {
  MatrixXd A;
  VectorXd b;
};

ProjectedRows project(const std::vector<RowsWithForces>& samples) {
  ProjectedRows rows{MatrixXd::Zero(1, samples.front().Y.cols()), VectorXd::Zero(1)};
  for (const RowsWithForces& s : samples) {
    const auto free = reference::eliminate_contacts(s.Y, s.F, s.J, s.weight);
    rows.A.conservativeResize(rows.A.rows() + free.Y.rows(), Eigen::NoChange);
    rows.A.bottomRows(free.Y.rows()) = free.Y;
    rows.b.conservativeResize(rows.b.size() + free.F.size());
    rows.b.tail(free.F.size()) = free.F;
  }
  return rows;
}

/// How well the forces of a sample are kept apart from the rest: condition of W^(1/2) J^T within
/// its rank.
double worst_condition(const std::vector<RowsWithForces>& samples) {
  double worst = 1.0;
  for (const RowsWithForces& s : samples) {
    const int rank = reference::contact_free_basis(s.J, s.weight).rank;
    if (rank == 0) continue;
    const MatrixXd forces = s.weight.cwiseSqrt().asDiagonal() * s.J.transpose();
    const VectorXd sigma = test::singular_values(forces);
    worst = std::max(worst, sigma[0] / sigma[rank - 1]);
  }
  return worst;
}

/// Both ways must have the same minimum, and the same x where the rows determine x.
void check_agreement(const std::vector<RowsWithForces>& samples) {
  const ProjectedRows rows = project(samples);
  const test::ForceAugmentedAnswer augmented = test::solve_with_forces(samples);
  const test::ThinSvd svd(rows.A);
  const VectorXd x = svd.solve(rows.b);
  const VectorXd& sigma = svd.sigma;

  double size = 0.0;  // || W^(1/2) F || of all rows, also of those that forces can reach
  Eigen::Index count = 0;
  for (const RowsWithForces& s : samples) {
    size += s.F.dot(s.weight.cwiseProduct(s.F));
    count += s.F.size();
  }
  size = std::sqrt(size) + sigma[0] * x.norm();
  const double forces = worst_condition(samples);
  const VectorXd residual = rows.A * x - rows.b;

  // The norm of the residual is well conditioned, up to how well forces are told apart.
  RC_ASSERT(scaled(std::abs(residual.norm() - std::sqrt(augmented.objective)), forces * size,
                   count) < few_hundred_eps);
  RC_ASSERT(scaled(std::abs((rows.A * augmented.x - rows.b).norm() - residual.norm()),
                   forces * size, count) < few_hundred_eps);

  // x moves by the condition of A, and by its square times the residual (Wedin's bound).
  const double smallest = sigma[sigma.size() - 1];
  const bool determined = sigma.size() == rows.A.cols() && smallest > 1e-6 * sigma[0];
  RC_TAG(determined ? "determined" : "undetermined");
  if (determined) {
    const double scale = size / smallest + sigma[0] * residual.norm() / (smallest * smallest);
    RC_ASSERT(scaled((x - augmented.x).norm(), forces * scale, count) < few_hundred_eps);
  }
}

/// Several samples of one robot with contacts changing; unknown are a few combinations of all
/// parameters, as the masses of shapes are.
RC_GTEST_PROP(ForceAugmented, SamePhiAndObjective, ()) {
  const Robot robot = (*test::robot_in_contact()).first;
  const int unknowns = *rc::gen::inRange(1, 7);
  const Eigen::Index parameters = Eigen::Index{10} * robot.link_count();
  const MatrixXd U = (*test::vector(parameters * unknowns, 1.0)).reshaped(parameters, unknowns);
  const VectorXd weight = *test::weights(robot.dof());
  std::vector<RowsWithForces> samples;
  for (int k = 0; k < 6; ++k) {
    const Sample s = *test::sample(robot);
    samples.push_back({reference::regressor(robot, s) * U, *test::vector(robot.dof(), 100.0),
                       reference::contact_jacobian(robot, s), weight});
  }
  check_agreement(samples);
}

// Every sample loses rank: of the leg's two torques one is left.
RC_GTEST_PROP(ForceAugmented, StretchedLegOnAFixedBase, ()) {
  const Robot robot = test::leg(Root::fixed);
  const MatrixXd U = (*test::vector(60, 1.0)).reshaped(30, 2);
  std::vector<RowsWithForces> samples;
  for (int k = 0; k < 6; ++k) {
    Sample s = test::posture(*test::real(-3.0, 3.0), 0.0);
    s.dq = *test::vector(2, 10.0);
    s.ddq = *test::vector(2, 100.0);
    s.in_contact = {true};
    samples.push_back({reference::regressor(robot, s) * U, *test::vector(2, 30.0),
                       reference::contact_jacobian(robot, s), *test::weights(2)});
  }
  check_agreement(samples);
}

}  // namespace
}  // namespace shapeid
