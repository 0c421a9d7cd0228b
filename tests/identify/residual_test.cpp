#include "shapeid/reference/residual.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "shapeid/reference/contact.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"
#include "shapeid/tests/support/svd.hpp"

namespace shapeid::reference {
namespace {

using test::few_hundred_eps;
using test::scaled;

/// I - J^T (J^T)^+ by singular values, J^T having full rank.
Eigen::MatrixXd projector(const Eigen::MatrixXd& J) {
  const Eigen::MatrixXd Q1 = test::ThinSvd(J.transpose()).U;
  return Eigen::MatrixXd::Identity(J.cols(), J.cols()) - Q1 * Q1.transpose();
}

RC_GTEST_PROP(Residual, IsWhatTheProjectorLeaves, ()) {
  Robot robot = *test::robot({.fewest_links = 4, .most_links = 8});
  robot.contacts.resize(std::min<std::size_t>(robot.contacts.size(), 1));
  RC_PRE(!robot.contacts.empty());
  Sample sample = *test::sample(robot);
  sample.in_contact = {true};
  const Eigen::VectorXd Phi = *test::vector(Eigen::Index{10} * robot.link_count(), 5.0);
  const Eigen::MatrixXd J = contact_jacobian(robot, sample);
  const Eigen::MatrixXd Y = regressor(robot, sample);
  const Eigen::VectorXd expected = projector(J) * (Y * Phi - applied_force(robot, sample));
  const Eigen::VectorXd found = residual(robot, sample, Phi, ContactTreatment::project);
  const double terms = Y.norm() * Phi.norm() + sample.tau.norm();
  RC_ASSERT(scaled((found - expected).norm(), terms, robot.dof()) < few_hundred_eps);
}

RC_GTEST_PROP(Residual, TableIsTheRootMeanSquareOfEachModel, ()) {
  const Robot robot = *test::robot({.fewest_links = 2, .most_links = 5, .root = Root::fixed});
  const Eigen::VectorXd a = stacked_parameters(robot);
  const Eigen::VectorXd b = *test::vector(a.size(), 2.0);
  ResidualTable table(robot, ContactTreatment::ignore, {a, b});
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(robot.dof(), 2);
  const int count = 3;
  for (int k = 0; k < count; ++k) {
    const Sample sample = *test::sample(robot);
    table.add(sample);
    const Eigen::MatrixXd Y = regressor(robot, sample);
    squares.col(0) += (Y * a - sample.tau).cwiseAbs2();
    squares.col(1) += (Y * b - sample.tau).cwiseAbs2();
  }
  const Eigen::MatrixXd expected = (squares / count).cwiseSqrt();
  RC_ASSERT(table.samples() == static_cast<std::size_t>(count));
  RC_ASSERT(scaled((table.rms() - expected).norm(), expected.norm() + a.norm() + b.norm(),
                   robot.dof()) < few_hundred_eps);
}

TEST(Residual, TableWithoutSamplesIsZero) {
  Robot robot;
  robot.links.resize(1);
  const ResidualTable table(robot, ContactTreatment::ignore, {Eigen::VectorXd::Ones(10)});
  EXPECT_TRUE(table.rms().isZero(0.0));
}

}  // namespace
}  // namespace shapeid::reference
