// Equations (1)-(3) against Simbody, which shares no code with us: other recursions (spatial
// operators), other frames, gravity as a force in a world where the base has a place, an attitude
// and a velocity.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <iostream>

#include "shapeid/models/simbody/simbody_robot.hpp"
#include "shapeid/reference/inverse_dynamics.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/physics/dynamics.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using test::few_hundred_eps;
using test::scaled;

/// What a property went through, to be printed: the cases counted and the worst of them.
struct Tally {
  std::size_t robots = 0, cases = 0;
  double worst = 0.0;  ///< scaled residual, in eps
};

void print(const Tally& tally) {
  std::cout << fmt::format("{} robots, {} cases, worst scaled residual {:.2g} eps\n", tally.robots,
                           tally.cases, tally.worst);
}

/// Robots with at least one degree of freedom.
rc::Gen<Robot> moving_robot(Root root, int most_links) {
  return test::robot({root == Root::fixed ? 2 : 1, most_links, root});
}

class AgreesWithSimbody : public testing::TestWithParam<Root> {};
INSTANTIATE_TEST_SUITE_P(Roots, AgreesWithSimbody, testing::Values(Root::floating, Root::fixed),
                         [](const auto& root) {
                           return root.param == Root::floating ? "floating" : "fixed";
                         });

/// How far Y Phi is from Simbody's inverse dynamics, in eps of the terms.
double disagreement(const Robot& robot, const SimbodyRobot& simbody, const Sample& s) {
  const double error =
      (reference::regressor(robot, s) * stacked_parameters(robot) - simbody.inverse_dynamics(s))
          .norm();
  return scaled(error, test::size_of_terms_with_weight(robot, s), robot.link_count());
}

// One robot in one state, which shrinks to something that can be read.
TEST_P(AgreesWithSimbody, YPhiIsInverseDynamics) {
  EXPECT_TRUE(rc::check("Y Phi = H qddot + C qdot + G", [&] {
    const Robot robot = *moving_robot(GetParam(), 20);
    RC_ASSERT(disagreement(robot, SimbodyRobot(robot), *test::sample(robot)) < few_hundred_eps);
  }));
}

TEST_P(AgreesWithSimbody, RecursionIsInverseDynamics) {
  EXPECT_TRUE(rc::check("link by link = H qddot + C qdot + G", [&] {
    const Robot robot = *moving_robot(GetParam(), 20);
    const Sample s = *test::sample(robot);
    const Eigen::VectorXd ours = reference::inverse_dynamics(
        robot, reference::link_motions(robot, s), stacked_parameters(robot));
    const double error = (ours - SimbodyRobot(robot).inverse_dynamics(s)).norm();
    RC_ASSERT(scaled(error, test::size_of_terms_with_weight(robot, s), robot.link_count()) <
              few_hundred_eps);
  }));
}

// The same in bulk. A Simbody system costs more than an inverse dynamics, so every robot is tried
// in several states. With rapidcheck's 100 rounds: 1000 robots, 10000 cases for each kind of root.
// Nothing shrinks here: a hundred cases a round would take minutes.
constexpr int robots_a_round = 10, states_a_robot = 10;

TEST_P(AgreesWithSimbody, YPhiIsInverseDynamicsInThousandsOfStates) {
  Tally tally;
  const bool holds = rc::check("Y Phi = H qddot + C qdot + G, in bulk", [&] {
    for (int r = 0; r < robots_a_round; ++r) {
      const Robot robot = *rc::gen::noShrink(moving_robot(GetParam(), 20));
      const SimbodyRobot simbody(robot);
      ++tally.robots;
      for (int k = 0; k < states_a_robot; ++k) {
        const double residual =
            disagreement(robot, simbody, *rc::gen::noShrink(test::sample(robot)));
        ++tally.cases;
        tally.worst = std::max(tally.worst, residual);
        RC_ASSERT(residual < few_hundred_eps);
      }
    }
  });
  print(tally);
  EXPECT_TRUE(holds);
}

/// Ten bodies that exist and span all ten parameters: a round one, then one at a time the centre
/// shifted along an axis, stretched along an axis, sheared in a plane.
Eigen::Matrix<double, 10, 10> spanning_bodies() {
  Eigen::Matrix<double, 10, 10> bodies;
  int k = 0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j <= i; ++j) {
      PseudoInertia sigma = PseudoInertia::Identity();
      sigma(i, j) += 0.5;
      if (i != j) sigma(j, i) += 0.5;
      bodies.col(k++) = from_pseudo_inertia(sigma).values;
    }
  }
  return bodies;
}

// Simbody refuses bodies that cannot exist, so a single column of Y comes from differences of
// bodies that can: what adding each of ten of them to a link adds to the generalised forces.
TEST_P(AgreesWithSimbody, EverySingleColumn) {
  const Eigen::Matrix<double, 10, 10> bodies = spanning_bodies();
  const Eigen::PartialPivLU<Eigen::Matrix<double, 10, 10>> span(bodies.transpose());
  // Solving with the ten bodies may lose this factor (reciprocal condition number).
  const double condition = 1.0 / span.rcond();
  ASSERT_LT(condition, 1000.0);  // they do span

  Tally tally;
  const bool holds = rc::check("columns of Y by differences of bodies", [&] {
    const Robot robot = *moving_robot(GetParam(), 6);
    const Sample s = *test::sample(robot);
    const int link = *rc::gen::inRange(0, robot.link_count());
    const Eigen::VectorXd without = SimbodyRobot(robot).inverse_dynamics(s);
    Eigen::MatrixXd added(robot.dof(), 10);
    double scale = 0.0;
    for (int k = 0; k < 10; ++k) {
      Robot heavier = robot;
      InertialParameters& body = heavier.links[static_cast<std::size_t>(link)].inertia;
      body.values += bodies.col(k);
      added.col(k) = SimbodyRobot(heavier).inverse_dynamics(s) - without;
      scale = std::max(scale, test::size_of_terms_with_weight(heavier, s));
    }
    const Eigen::MatrixXd columns = span.solve(added.transpose()).transpose();
    const Eigen::MatrixXd Y =
        reference::regressor(robot, s).middleCols<10>(Eigen::Index{10} * link);
    ++tally.robots;
    for (int c = 0; c < 10; ++c) {
      const double residual = scaled((Y.col(c) - columns.col(c)).norm(), condition * scale, 10);
      ++tally.cases;
      tally.worst = std::max(tally.worst, residual);
      RC_ASSERT(residual < few_hundred_eps);
    }
  });
  print(tally);
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace shapeid
