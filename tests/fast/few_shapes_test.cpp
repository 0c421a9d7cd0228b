// The first answer for few shapes of a link: how often it is right, and that a wrong one is
// refused.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/SVD>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shapeid/fast/active_set.hpp"
#include "shapeid/fast/few_shapes.hpp"
#include "shapeid/fast/one_link.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"
#include "shapeid/tests/support/qp_generators.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid::fast {
namespace {

using test::few_hundred_eps;
using test::TriangleCase;

/// A guess, and the method that judges it, on one problem.
class Judged {
 public:
  explicit Judged(const TriangleCase& given)
      : given_(given), columns_(1, given.shapes()), vertex_(columns_), method_(columns_, V()) {
    for (int j = 0; j < given.shapes(); ++j) {
      static_cast<void>(columns_.append(0, given.column(j)));
      guess_.put(j, given.column(j));
    }
    method_.use(vertex_, given.problem.lambda);
    static_cast<void>(method_.take(given.R));
  }

  bool guess(const Eigen::MatrixXd& R, const std::vector<int>& passive = {}) {
    LinkRows rows;
    rows.take(R);
    return guess_.guess(V(), given_.problem.lambda, rows, passive);
  }
  bool settles() { return method_.settles_at(guess_); }
  [[nodiscard]] Eigen::VectorXd masses() const {
    Eigen::VectorXd m = Eigen::VectorXd::Zero(given_.shapes());
    for (std::size_t i = 0; i < method_.passive().size(); ++i) {
      m[method_.passive()[i]] = method_.masses()[i];
    }
    return m;
  }
  [[nodiscard]] FewShapes& pivots() { return guess_; }

 private:
  [[nodiscard]] const Eigen::VectorXd& V() const { return given_.problem.V; }

  FewShapes guess_;  // first: its members are the most strictly aligned
  const TriangleCase& given_;
  ShapeColumns columns_;
  OneLink vertex_;
  ActiveSet method_;
};

TriangleCase some_case(std::uint64_t seed, int shapes, bool density_term, double noise = 1e-2) {
  return test::body_case(seed,
                         {.shapes_a_link = shapes, .noise = noise, .density_term = density_term});
}

/// Of 300 problems, how many the guess settles; each of these is right.
int settled(bool density_term, bool warm) {
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const TriangleCase given =
        some_case(seed, 1 + static_cast<int>(seed % FewShapes::most_shapes), density_term);
    std::vector<int> start;
    for (int j = 0; warm && j < given.shapes(); ++j) {
      if ((seed >> (j % 8)) % 2 == 1) start.push_back(j);
    }
    Judged judged(given);
    if (!judged.guess(given.R, start) || !judged.settles()) continue;
    ++count;
    const Eigen::VectorXd m = reference::solve_masses(given.problem).m;
    EXPECT_LT(test::scaled_objective_difference(given.problem, judged.masses(), m),
              few_hundred_eps);
    EXPECT_LT(reference::kkt_residual(given.problem, judged.masses()).worst(), 1e-13);
    if (density_term) {
      EXPECT_LT(test::scaled_mass_difference(given.problem, judged.masses(), m), few_hundred_eps);
    }
  }
  return count;
}

TEST(FewShapes, AreSettledAlmostAlways) {
  for (const bool warm : {false, true}) {
    // All 300 where this was written; other compilers may round a tie otherwise.
    EXPECT_GE(settled(false, warm), 298);
    EXPECT_GE(settled(true, warm), 298);
  }
}

// A guess from other forces has other masses: either they can be corrected to the minimum, or they
// are refused.
RC_GTEST_PROP(FewShapes, OfOtherForcesAreCorrectedOrRefused, ()) {
  const TriangleCase given =
      some_case(*rc::gen::arbitrary<std::uint64_t>(),
                *rc::gen::inRange(2, FewShapes::most_shapes + 1), *rc::gen::arbitrary<bool>());
  Judged judged(given);
  Eigen::MatrixXd R = given.R;
  R(*rc::gen::inRange(0, 10), 10) += *rc::gen::element(1e-9, 1e-3, 1.0) * R.col(10).norm();
  RC_PRE(judged.guess(R));
  if (!judged.settles()) return;
  const Eigen::VectorXd wanted = reference::solve_masses(given.problem).m;
  RC_ASSERT(test::scaled_objective_difference(given.problem, judged.masses(), wanted) <
            few_hundred_eps);
}

// Most such guesses have other passive shapes, and no correction makes them right.
TEST(FewShapes, OfAnotherWindowAreRefused) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const TriangleCase given = some_case(seed, 9, false), other = some_case(seed + 1000, 9, false);
    Eigen::MatrixXd R = given.R;
    R.rightCols<1>() = other.R.rightCols<1>();
    Judged judged(given);
    if (judged.guess(R) && !judged.settles()) ++refused;
  }
  EXPECT_GE(refused, 80);
}

RC_GTEST_PROP(FewShapes, SolveTheirNormalEquations, ()) {
  const TriangleCase given = some_case(*rc::gen::arbitrary<std::uint64_t>(),
                                       *rc::gen::inRange(1, FewShapes::most_shapes + 1), true);
  Judged judged(given);
  RC_PRE(judged.guess(given.R));
  std::vector<int> passive;
  for (int j = 0; j < given.shapes(); ++j) {
    if (judged.pivots().is_passive(j)) passive.push_back(j);
  }
  const Eigen::MatrixXd A = (given.problem.Y * given.problem.U)(Eigen::all, passive);
  const Eigen::VectorXd stiffness = given.problem.lambda * given.problem.V(passive).cwiseInverse();
  const auto n = static_cast<Eigen::Index>(passive.size());
  RC_PRE(n > 0);
  const Eigen::MatrixXd H = A.transpose() * A + Eigen::MatrixXd(stiffness.asDiagonal());
  const Eigen::VectorXd planted = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  Eigen::VectorXd x = H * planted;
  judged.pivots().solve_normal(x);
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Eigen::MatrixXd>(H).singularValues();
  // An explicit inverse leaves what the condition of H leaves.
  const double condition = sizes[0] / sizes[n - 1];
  RC_ASSERT(test::scaled((x - planted).norm(), planted.norm() * condition, n) < few_hundred_eps);
}

TEST(FewShapes, TakeNoMoreThanADozen) {
  const TriangleCase given = some_case(1, FewShapes::most_shapes + 1, false);
  FewShapes guess;
  for (int j = 0; j < given.shapes(); ++j) {
    EXPECT_TRUE(guess.fits());
    guess.put(j, given.column(j));
  }
  EXPECT_FALSE(guess.fits());
  guess.clear();
  EXPECT_TRUE(guess.fits());
}

}  // namespace
}  // namespace shapeid::fast
