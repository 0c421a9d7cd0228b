// What a solver keeps from call to call: the scale of its rows, lambda, and whether its masses are
// an answer.
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "shapeid/fast/mass_solver.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using fast::MassSolver;
using fast::Outcome;

/// Registers of four want addresses of their own, which a type must ask for: on the heap, and in an
/// object of somebody else. (Until 2026-11-28 none did, and it was luck that no test ended here.)
TEST(FastMassState, StandsAtEveryAddressThatItsTypeAllows) {
  constexpr std::size_t most = 64;
  std::vector<std::byte> memory(sizeof(MassSolver) + 2 * most);
  for (const int links : {1, 2}) {
    for (const double lambda : {0.0, 1e-3}) {
      for (std::size_t off = 0; off < most; off += alignof(MassSolver)) {
        void* place = memory.data();
        std::size_t room = memory.size();
        ASSERT_NE(std::align(most, sizeof(MassSolver) + most, place, room), nullptr);
        auto* const solver = new (static_cast<std::byte*>(place) + off) MassSolver(links, 40);
        solver->set_lambda(lambda);
        MatrixXd R = MatrixXd::Identity(10 * links + 1, 10 * links + 1);
        R.rightCols<1>().setOnes();
        for (int j = 0; j < 40; ++j) {
          ASSERT_TRUE(solver->append(j % links, MassSolver::Column::Unit(j % 10), 1.0));
          if (j == 5 || j == 39) {
            EXPECT_EQ(solver->solve(R), Outcome::solved);
          }
        }
        solver->~MassSolver();
      }
    }
  }
}

/// In any unit: a slope is small beside what the rows make it of.
TEST(FastMassState, PartsOfAShapeWithoutMassAreAskedInAnyUnit) {
  for (const double unit : {1.0, 1e-8, 1e8}) {
    MatrixXd R = MatrixXd::Zero(11, 11);
    R(0, 0) = R(1, 1) = R(2, 2) = unit;
    R(0, 10) = 2.0 * unit;
    R(1, 10) = unit;
    MassSolver solver(1, 4);
    ASSERT_TRUE(solver.append(0, MassSolver::Column::Unit(0), 1.0));
    ASSERT_TRUE(solver.append(0, -MassSolver::Column::Unit(1), 2.0));
    ASSERT_EQ(solver.solve(R), Outcome::solved);
    ASSERT_TRUE(solver.divide(1, -3.0 * MassSolver::Column::Unit(1), 1.0,
                              MassSolver::Column::Unit(1), 1.0));
    ASSERT_EQ(solver.solve_again(), Outcome::solved);
    EXPECT_NEAR(solver.m()[2], 1.0, 1e-9) << unit;
  }
}

/// A shape that comes after an answer is asked, too, as parts are of shapes that have no mass.
TEST(FastMassState, AShapeThatComesAfterAnAnswerIsAsked) {
  for (const int links : {1, 2}) {
    for (const double lambda : {0.0, 1e-6}) {
      MatrixXd R = MatrixXd::Identity(10 * links + 1, 10 * links + 1);
      R.rightCols<1>().setOnes();
      MassSolver solver(links, 40);
      solver.set_lambda(lambda);
      for (int j = 0; j < 16; ++j) {
        ASSERT_TRUE(solver.append(0, (1.0 + 0.01 * j) * MassSolver::Column::Unit(0), 1.0));
      }
      ASSERT_EQ(solver.solve(R), Outcome::solved);
      ASSERT_EQ(solver.solve_again(), Outcome::solved);
      ASSERT_TRUE(solver.append(links - 1, MassSolver::Column::Unit(1), 1.0));
      ASSERT_EQ(solver.solve_again(), Outcome::solved);
      EXPECT_NEAR(solver.m()[16], 1.0, 1e-5) << links << " links, lambda " << lambda;
    }
  }
}

/// Slopes of lambda's size let a part in that rows do not tell from the others: it stands where the
/// density of these, which is a polynomial in the place, is positive.
TEST(FastMassState, APartEntersByWhatLambdaAlone) {
  const auto u = [](double x) {
    MassSolver::Column point = MassSolver::Column::Zero();
    point[0] = 1.0;
    point[1] = x;
    return point;
  };
  MatrixXd R = MatrixXd::Zero(11, 11);
  R(0, 0) = R(1, 1) = 1.0;
  R(0, 10) = 6.0;  // kg, at 1/6 m
  R(1, 10) = 1.0;
  MassSolver solver(1, 20);
  solver.set_lambda(1e-15);
  // One more than pivots have places for, and a long one far out, where the density is below zero.
  for (int j = 0; j < 13; ++j) ASSERT_TRUE(solver.append(0, u(0.1 * (j - 6)), 1.0));
  ASSERT_TRUE(solver.append(0, u(-4.0), 2.0));
  ASSERT_EQ(solver.solve(R), Outcome::solved);
  ASSERT_EQ(solver.m()[13], 0.0);
  ASSERT_GT(solver.passive().size(), 12U);
  ASSERT_TRUE(solver.divide(13, u(-8.1), 1.0, u(0.1), 1.0));
  ASSERT_EQ(solver.solve_again(), Outcome::solved);
  EXPECT_EQ(solver.m()[13], 0.0);
  EXPECT_GT(solver.m()[14], 0.1);
}

/// The density term is that of the lambda that is set, whatever it was before.
TEST(FastMassState, ALambdaThatIsTakenAwayLeavesNothing) {
  MatrixXd R = MatrixXd::Zero(21, 21);
  R.diagonal().head(20).setOnes();
  R.col(20).head(20).setOnes();
  MassSolver solver(2, 8);
  solver.set_lambda(1e-11);
  for (const int link : {0, 1}) {
    for (const int i : {0, 1, 2}) {
      ASSERT_TRUE(solver.append(link, MassSolver::Column::Unit(i), 0.5));
    }
  }
  ASSERT_EQ(solver.solve(R), Outcome::solved);
  EXPECT_GT(solver.value().density, 0.0);
  solver.set_lambda(0.0);
  ASSERT_EQ(solver.solve_again(), Outcome::solved);
  EXPECT_EQ(solver.value().density, 0.0);
  for (const double m : solver.m()) EXPECT_NEAR(m, 1.0, 1e-12);
}

/// A stiffness that overflows has no answer, and is not given one.
TEST(FastMassState, NoMassesAreGivenOutThatAreNoNumbers) {
  MatrixXd R = MatrixXd::Identity(11, 11);
  R.col(10).setOnes();
  R(10, 10) = 0.0;
  for (const double lambda : {std::numeric_limits<double>::infinity(), 1e300}) {
    MassSolver solver(1, 4);
    solver.set_lambda(lambda);
    for (const int i : {0, 1, 2}) {
      ASSERT_TRUE(
          solver.append(0, MassSolver::Column::Unit(i) + 0.5 * MassSolver::Column::Unit(3), 1e-12));
    }
    const Outcome outcome = solver.solve(R);
    EXPECT_TRUE(outcome != Outcome::solved || solver.m().allFinite()) << lambda;
  }
}

/// Masses to start at are no answer that a division could change.
TEST(FastMassState, DividesMassesThatWereSetSinceTheLastAnswer) {
  MatrixXd R = MatrixXd::Identity(11, 11);
  R.col(10).setOnes();
  R(10, 10) = 0.0;
  MassSolver solver(1, 4);
  ASSERT_TRUE(solver.append(0, MassSolver::Column::Unit(0), 1.0));
  ASSERT_TRUE(solver.append(0, MassSolver::Column::Unit(1), 1.0));
  ASSERT_EQ(solver.solve(R), Outcome::solved);
  solver.start_at(0, 5.0);
  ASSERT_TRUE(
      solver.divide(0, 2.0 * MassSolver::Column::Unit(0), 0.5, MassSolver::Column::Zero(), 0.5));
  EXPECT_FALSE(solver.why_changed());
  ASSERT_EQ(solver.solve(R), Outcome::solved);
  EXPECT_NEAR(solver.m()[0], 0.5, 1e-12);
}

}  // namespace
}  // namespace shapeid
