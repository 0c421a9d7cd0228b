// Answers of both paths and of nobody: accepted, or rejected for the right reason.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "shapeid/fast/solve_masses.hpp"
#include "shapeid/proofs/certificate/certify.hpp"
#include "shapeid/proofs/certificate/exact_problem.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/oracle.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/certificate/verdict.hpp"
#include "shapeid/tests/support/generators.hpp"

namespace shapeid::certificate {
namespace {

using test::honest_answer;

std::string first_reason(const Certified& c) {
  return c.reasons.empty() ? "accepted" : c.reasons.front();
}

TEST(Certify, AcceptsBothPathsAndKnowsTheOptimum) {
  for (const double lambda : {1.0, 0.0}) {
    StatedProblem p = test::load_problem();
    p.masses.lambda *= lambda;
    const auto fast = fast::solve_masses(p.masses);
    ASSERT_TRUE(fast);
    for (const Eigen::VectorXd& m : {reference::solve_masses(p.masses).m, fast->m}) {
      const Certified c = certify(p, honest_answer(p, m));
      EXPECT_EQ(first_reason(c), "accepted");
      EXPECT_TRUE(c.proof.optimum_known);
      EXPECT_TRUE(c.proof.free_set_right);
      EXPECT_LE(c.proof.lower, c.proof.upper);
      EXPECT_LE(c.proof.upper, c.proof.objective_above);
      EXPECT_LT(c.proof.gap, 1e-12 * c.proof.upper);
      EXPECT_EQ(c.proof.bodies, std::vector{Existence::definite});
    }
  }
}

TEST(Certify, NamesEveryNegativeMass) {
  StatedProblem p = test::load_problem();
  p.masses.mass_bound = 10.0;
  const Eigen::VectorXd m = reference::solve_masses(p.masses).m;
  for (const Eigen::Index j : {Eigen::Index{0}, m.size() / 2, m.size() - 1}) {
    Eigen::VectorXd wrong = m;
    wrong[j] = -0.125;
    const Certified c = certify(p, honest_answer(p, wrong));
    EXPECT_FALSE(c.proof.feasible);
    EXPECT_EQ(first_reason(c), "mass " + std::to_string(j) + " is negative: -0.125 kg");
    EXPECT_EQ(c.proof.mass_bound, 10.0);
    EXPECT_TRUE(c.proof.mass_bound_declared);
  }
}

TEST(Certify, JudgesTheBodyOfEveryLink) {
  const StatedProblem p = test::body_problem(2);
  Eigen::VectorXd m = Eigen::VectorXd::Constant(p.masses.U.cols(), 0.5);
  m.tail<2>().setZero();  // the last link has no mass
  const Certified c = certify(p, honest_answer(p, m));
  std::vector<Existence> bodies(12, Existence::definite);
  bodies.push_back(Existence::semidefinite);
  EXPECT_EQ(c.proof.bodies, bodies);
}

/// The interval holds the optimum of all active sets. Answered is what was drawn, as far as the
/// bounds allow it, or the optimum but for rounding.
void expect_optimum_in_interval(const StatedProblem& p, const test::ExactMinimum& truth) {
  Eigen::VectorXd m = (*test::vector(p.masses.shapes(), 1.0)).cwiseMax(0.0);
  if (p.masses.mass_bound > 0.0) m *= std::min(1.0, 0.9 * p.masses.mass_bound / (m.sum() + 1e-9));
  Eigen::VectorXd x = *test::vector(p.others.values.cols(), 1.0);
  if (*rc::gen::arbitrary<bool>()) {
    for (Eigen::Index j = 0; j < m.size(); ++j) {
      m[j] = rounded_down(truth.m[static_cast<std::size_t>(j)]);
    }
    for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = truth.x[static_cast<std::size_t>(k)].get_d();
  }
  x = x.cwiseMax(p.others.lower).cwiseMin(p.others.upper);
  const Proof proof = certify(p, honest_answer(p, m, x)).proof;
  const mpq_class f = test::exact_objective(p, m, x);
  RC_ASSERT(proof.feasible);
  RC_ASSERT(mpq_class(proof.lower) <= truth.value);
  RC_ASSERT(truth.value <= mpq_class(proof.upper));
  RC_ASSERT(f <= mpq_class(proof.objective_above));
  RC_ASSERT(f - truth.value <= mpq_class(proof.gap));
  if (std::isfinite(proof.mass_distance) && p.masses.lambda > 0.0) {
    for (Eigen::Index j = 0; j < m.size(); ++j) {
      const mpq_class apart = abs(truth.m[static_cast<std::size_t>(j)] - mpq_class(m[j]));
      RC_ASSERT(apart <= mpq_class(proof.mass_distance));
    }
  }
}

RC_GTEST_PROP(Certify, IntervalHoldsTheOptimumWhateverIsAnswered, ()) {
  const StatedProblem p = *test::small_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(p.masses.F.size() >= p.others.values.cols());
  expect_optimum_in_interval(p, test::minimum_of_all_active_sets(p));
}

/// Of at most a declared mass, which mostly holds the optimum back.
RC_GTEST_PROP(Certify, IntervalHoldsTheOptimumOfADeclaredMass, ()) {
  StatedProblem p = *test::small_problem(*rc::gen::arbitrary<bool>());
  RC_PRE(p.masses.F.size() >= p.others.values.cols());
  const double total = rounded_up(sum(test::minimum_of_all_active_sets(p).m));
  RC_PRE(total > 0.0);
  p.masses.mass_bound = *rc::gen::element(0.01, 0.3, 0.9, 1.0, 1.5) * total;
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(p);
  RC_CLASSIFY(sum(truth.m) == exact(p.masses.mass_bound), "at the bound");
  expect_optimum_in_interval(p, truth);
}

/// Where the optimum is known all distances are from it, rounded up; else they are bounds. Group by
/// group: kg, kg m, kg m^2.
RC_GTEST_PROP(Certify, DistancesAreFromTheOptimum, ()) {
  const StatedProblem p = *test::small_problem(false);
  RC_PRE(p.masses.F.size() >= p.others.values.cols());
  const test::ExactMinimum truth = test::minimum_of_all_active_sets(p);
  const Eigen::VectorXd m = (*test::vector(p.masses.shapes(), 1.0)).cwiseMax(0.0);
  const Eigen::VectorXd x = (*test::vector(p.others.values.cols(), 1.0))
                                .cwiseMax(p.others.lower)
                                .cwiseMin(p.others.upper);
  const Answer answer = honest_answer(p, m, x);
  const Proof proof = certify(p, answer).proof;
  Rational farthest;
  for (Eigen::Index j = 0; j < m.size(); ++j) {
    farthest =
        std::max<Rational>(farthest, abs(truth.m[static_cast<std::size_t>(j)] - exact(m[j])));
  }
  const Vector best = ExactProblem(p).U.times(truth.m);
  std::array<Rational, 3> groups;
  for (Eigen::Index i = 0; i < answer.parameters.size(); ++i) {
    Rational& group = groups[i % 10 == 0 ? 0 : (i % 10 < 4 ? 1 : 2)];
    const Rational apart = exact(answer.parameters[i]) - best[static_cast<std::size_t>(i)];
    group = std::max<Rational>(group, abs(apart));
  }
  RC_CLASSIFY(proof.optimum_known, "known");
  if (!proof.optimum_known) {
    RC_ASSERT(proof.mass_distance >= rounded_down(farthest));
    return;
  }
  RC_ASSERT(proof.lower == rounded_down(truth.value));
  RC_ASSERT(proof.upper == rounded_up(truth.value));
  RC_ASSERT(proof.gap == rounded_up(test::exact_objective(p, m, x) - truth.value));
  RC_ASSERT(proof.objective_above == rounded_up(test::exact_objective(p, m, x)));
  RC_ASSERT(proof.mass_distance == rounded_up(farthest));
  for (Eigen::Index g = 0; g < 3; ++g) {
    RC_ASSERT(proof.parameter_distance[g] == rounded_up(groups[static_cast<std::size_t>(g)]));
  }
}

/// A bound belongs to what is allowed; what is beyond it by a rounding does not.
TEST(Certify, ColumnsMayReachTheirBounds) {
  StatedProblem p = test::load_problem();
  p.others.values = p.masses.F;
  p.others.lower = Eigen::VectorXd::Constant(1, -0.25);
  p.others.upper = Eigen::VectorXd::Constant(1, 0.5);
  const auto feasible = [&](double x) {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(p.masses.shapes());
    const Certified c = certify(p, honest_answer(p, none, Eigen::VectorXd::Constant(1, x)));
    const bool is_named = first_reason(c).starts_with("column 0 is beyond its bounds");
    EXPECT_EQ(c.proof.feasible, !is_named);
    return c.proof.feasible;
  };
  EXPECT_TRUE(feasible(-0.25));
  EXPECT_TRUE(feasible(0.5));
  EXPECT_FALSE(feasible(std::nextafter(-0.25, -1.0)));
  EXPECT_FALSE(feasible(std::nextafter(0.5, 1.0)));
}

TEST(Certify, RejectsWrongAnswers) {
  const StatedProblem p = test::load_problem();
  const Eigen::VectorXd m = reference::solve_masses(p.masses).m;
  Eigen::Index heaviest = 0;
  const double mass = m.maxCoeff(&heaviest);
  const auto with = [&](Eigen::Index j, double value) {
    Eigen::VectorXd wrong = m;
    wrong[j] = value;
    return certify(p, honest_answer(p, wrong));
  };
  EXPECT_NE(first_reason(with(heaviest, 1.001 * mass)).find("above the optimum"),
            std::string::npos);
  EXPECT_NE(first_reason(with(heaviest, 0.0)).find("above the optimum"), std::string::npos);
  EXPECT_NE(first_reason(with(heaviest, -mass)).find("negative"), std::string::npos);
  EXPECT_NE(first_reason(with(heaviest, 11.0)).find("declares no more"), std::string::npos);
}

/// m = 0 certifies itself wherever the mass bound is the answer's own sum.
TEST(Certify, RejectsNoMassAtAll) {
  for (const double declared : {10.0, 0.0}) {
    StatedProblem p = test::load_problem();
    p.masses.mass_bound = declared;
    const Certified c = certify(p, honest_answer(p, Eigen::VectorXd::Zero(p.masses.shapes())));
    EXPECT_NE(first_reason(c).find("above the optimum"), std::string::npos);
    EXPECT_EQ(c.proof.mass_bound_declared, declared > 0.0);
  }
}

/// The bound on the mass is part of the problem: what lies beyond it is no optimum.
TEST(Certify, OptimumAtTheMassBound) {
  const StatedProblem p = test::one_point_problem();
  constexpr double best = 0.125, optimum = 0.78125;  // (7/8)^2 + (1/8)^2
  const Proof none = certify(p, honest_answer(p, Eigen::VectorXd::Zero(1))).proof;
  EXPECT_FALSE(none.optimum_known);
  EXPECT_LE(none.lower, optimum);
  EXPECT_GE(none.upper, optimum);
  EXPECT_GE(none.mass_distance, best);
  const Certified at_bound = certify(p, honest_answer(p, Eigen::VectorXd::Constant(1, best)));
  EXPECT_EQ(first_reason(at_bound), "accepted");
  EXPECT_EQ(at_bound.proof.lower, optimum);
  EXPECT_EQ(at_bound.proof.upper, optimum);
}

/// Without a density term masses are not unique: an answer reaches the optimum, or nothing is said.
TEST(Certify, DistancesWithoutADensityTermAreNoneOrUnknown) {
  StatedProblem p = test::one_point_problem();
  p.masses.lambda = p.masses.mass_bound = 0.0;
  const Proof reached = certify(p, honest_answer(p, Eigen::VectorXd::Ones(1))).proof;
  EXPECT_EQ(reached.gap, 0.0);
  EXPECT_EQ(reached.mass_distance, 0.0);
  EXPECT_TRUE(reached.parameter_distance.isZero(0.0));
  const Proof missed = certify(p, honest_answer(p, Eigen::VectorXd::Constant(1, 0.5))).proof;
  EXPECT_EQ(missed.gap, 0.25);
  EXPECT_EQ(missed.mass_distance, HUGE_VAL);
  EXPECT_EQ(missed.parameter_distance, Eigen::Vector3d::Constant(HUGE_VAL));
  // Of two optima a kilogram apart each is one.
  p.masses.U = Eigen::MatrixXd::Zero(10, 2);
  p.masses.U.row(0).setOnes();
  p.masses.V = Eigen::VectorXd::Ones(2);
  for (const Eigen::Vector2d& m : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
    EXPECT_EQ(certify(p, honest_answer(p, m)).proof.mass_distance, 0.0);
  }
}

/// Where even the exact steps do not find the free set, duality alone says how far it is.
TEST(Certify, DualityAloneIsTight) {
  StatedProblem p = test::load_problem();
  p.masses.lambda = 0.0;  // then a wrong free set is not mended
  Eigen::VectorXd m = reference::solve_masses(p.masses).m;
  const double optimum = certify(p, honest_answer(p, m)).proof.upper;
  constexpr double left = 1e-13;  // kg, as an interior method leaves it
  for (double& mass : m) {
    if (mass == 0.0) mass = left;
  }
  const Certified c = certify(p, honest_answer(p, m));
  EXPECT_EQ(first_reason(c), "accepted");
  EXPECT_FALSE(c.proof.optimum_known);
  EXPECT_LE(c.proof.lower, optimum);
  // A kilogram changes the objective by about the data's own size, and M kilograms may move.
  const double size = p.masses.F.dot(p.masses.W.cwiseProduct(p.masses.F));
  const double shapes = static_cast<double>(p.masses.shapes());
  EXPECT_LT(c.proof.gap, 2.0 * (1.0 + p.masses.mass_bound) * shapes * left * size);
}

Answer parameters_alone(const StatedProblem& p, const Eigen::VectorXd& m) {
  Answer answer = honest_answer(p, m);
  answer.masses.resize(0);
  return answer;
}

TEST(Certify, ParametersAloneAreEnough) {
  for (const double lambda : {1.0, 0.0}) {
    StatedProblem p = test::load_problem();
    p.masses.lambda *= lambda;
    Answer alone = parameters_alone(p, reference::solve_masses(p.masses).m);
    const Certified c = certify(p, alone);
    EXPECT_EQ(first_reason(c), "accepted") << lambda;
    // Which density term a solver had in its objective its parameters do not say.
    alone.objective += 1.0;
    EXPECT_EQ(first_reason(certify(p, alone)), "accepted") << lambda;
    EXPECT_TRUE(c.proof.optimum_known || lambda == 0.0);
  }
}

/// The optimum weighs half a kilogram: a bound of as much allows it, any less does not.
TEST(Certify, ABoundOnTheMassMayBeMet) {
  StatedProblem p = test::one_point_problem();
  constexpr double best = 0.5;
  for (const double bound : {best, std::nextafter(best, 1.0), std::nextafter(best, 0.0)}) {
    p.masses.mass_bound = bound;
    const Certified c = certify(p, honest_answer(p, Eigen::VectorXd::Constant(1, best)));
    EXPECT_EQ(c.proof.feasible, bound >= best);
    EXPECT_EQ(c.proof.optimum_known, bound >= best);
  }
}

TEST(Certify, ParametersThatAreNotMadeOfTheShapesAreSeparated) {
  const StatedProblem p = test::load_problem();
  // The unconstrained least squares fit: lower objective, no body of these shapes.
  const Eigen::VectorXd Phi = p.masses.Y.colPivHouseholderQr().solve(p.masses.F);
  Answer answer = parameters_alone(p, Eigen::VectorXd::Zero(p.masses.shapes()));
  answer.parameters = Phi;
  const Certified c = certify(p, answer);
  EXPECT_NE(first_reason(c).find("nearest body of the shapes"), std::string::npos);
  EXPECT_FALSE(c.proof.made_of_shapes);
  ASSERT_EQ(c.proof.plane.size(), 10);
  EXPECT_LT(c.proof.plane.dot(Phi), 0.0);
  EXPECT_GE((p.masses.U.transpose() * c.proof.plane).minCoeff(),
            -1e-12 * c.proof.plane.norm() * p.masses.U.colwise().norm().maxCoeff());
}

/// Parameters alone have no masses whose free set could be right.
TEST(Certify, ParametersAloneHaveNoFreeSet) {
  const StatedProblem p = test::one_point_problem();
  const Proof proof = certify(p, parameters_alone(p, Eigen::VectorXd::Constant(1, 0.125))).proof;
  EXPECT_FALSE(proof.free_set_right);
  StatedProblem unbounded = p;
  unbounded.masses.mass_bound = 0.0;
  const Answer best = honest_answer(unbounded, Eigen::VectorXd::Constant(1, 0.5));
  EXPECT_TRUE(certify(unbounded, best).proof.free_set_right);
  Answer alone = best;
  alone.masses.resize(0);
  const Proof known = certify(unbounded, alone).proof;
  EXPECT_TRUE(known.optimum_known);
  EXPECT_FALSE(known.free_set_right);
}

/// What negative masses make is not made of the shapes.
TEST(Certify, NegativeMassesMakeNoBody) {
  const StatedProblem p = test::one_point_problem();
  EXPECT_TRUE(
      certify(p, honest_answer(p, Eigen::VectorXd::Constant(1, 0.125))).proof.made_of_shapes);
  EXPECT_FALSE(
      certify(p, honest_answer(p, Eigen::VectorXd::Constant(1, -0.125))).proof.made_of_shapes);
}

/// Where there is no shape nothing is left to choose, and the objective is judged.
TEST(Certify, TheObjectiveOfNoShapesCounts) {
  StatedProblem p = test::load_problem();
  p.masses.U.resize(p.masses.U.rows(), 0);
  p.masses.V.resize(0);
  p.shapes.clear();
  Answer answer = honest_answer(p, Eigen::VectorXd(0));
  EXPECT_EQ(first_reason(certify(p, answer)), "accepted");
  answer.objective = -123.0;
  EXPECT_NE(first_reason(certify(p, answer)).find("the objective is said to be"),
            std::string::npos);
}

/// A file of a few bytes a link must not ask for hours: what would is not sought, and the bound
/// from duality stands.
TEST(Certify, LinksWithoutRowsAreNotSolvedFor) {
  StatedProblem p;
  constexpr Eigen::Index parameters = 3000;
  p.masses.Y.resize(1, parameters);
  p.masses.Y.setZero();
  p.masses.F = Eigen::VectorXd::Constant(1, 2.0);
  p.masses.W = Eigen::VectorXd::Ones(1);
  p.masses.U.resize(parameters, 0);
  p.masses.lambda = 1.0;
  const Certified c = certify(p, honest_answer(p, Eigen::VectorXd(0)));
  EXPECT_EQ(first_reason(c), "accepted");
  EXPECT_FALSE(c.proof.optimum_known);
  EXPECT_EQ(c.proof.lower, 4.0);
}

TEST(Certify, SizesThatDoNotFitAreSaid) {
  const StatedProblem p = test::load_problem();
  const Answer good = honest_answer(p, Eigen::VectorXd::Zero(p.masses.shapes()));
  EXPECT_FALSE(why_unfit(p, good));
  Answer bad = good;
  bad.masses.resize(3);
  EXPECT_EQ(*why_unfit(p, bad), "3 masses for 48 shapes");
  bad = good;
  bad.parameters.resize(11);
  EXPECT_EQ(*why_unfit(p, bad), "11 parameters, the problem has 10");
  bad = good;
  bad.others.resize(1);
  EXPECT_EQ(*why_unfit(p, bad), "1 columns, the problem has 0");
}

/// Nothing to find, and nothing to find it from.
TEST(Certify, EmptyProblems) {
  StatedProblem p;
  p.masses.Y.resize(2, 0);
  p.masses.U.resize(0, 0);
  p.masses.F = Eigen::Vector2d(1.0, 2.0);
  p.masses.W = Eigen::Vector2d(1.0, 1.0);
  const Certified c = certify(p, honest_answer(p, Eigen::VectorXd(0)));
  EXPECT_EQ(first_reason(c), "accepted");
  EXPECT_EQ(c.proof.lower, 5.0);
  StatedProblem zero = test::load_problem();
  zero.masses.F.setZero();
  const Certified none =
      certify(zero, honest_answer(zero, Eigen::VectorXd::Zero(zero.masses.shapes())));
  EXPECT_EQ(first_reason(none), "accepted");
  EXPECT_EQ(none.proof.upper, 0.0);
}

/// Doubles from the smallest to the largest: slow perhaps, never wrong, never a crash.
TEST(Certify, ExtremeNumbers) {
  StatedProblem p = test::load_problem();
  p.masses.mass_bound = 0.0;
  p.masses.Y *= 1e300;
  p.masses.F.setConstant(-5e-324);
  p.masses.W.setConstant(1e-300);
  p.masses.W[0] = 1e308;
  p.masses.V[0] = 5e-324;
  p.masses.U(0, 1) = 1e308;
  const Answer none = honest_answer(p, Eigen::VectorXd::Zero(p.masses.shapes()));
  const Guess none_guess{none.parameters, {}};
  const Certified best = certify(p, none, {}, {none_guess, none_guess, none_guess});
  EXPECT_TRUE(best.proof.feasible);
  EXPECT_LE(best.proof.lower, best.proof.upper);
  const Answer heavy{none.problem_digest, Eigen::VectorXd::Constant(p.masses.shapes(), 1e308),
                     none.parameters, 0.0};
  EXPECT_FALSE(certify(p, heavy).reasons.empty());
  Answer alone = none;
  alone.masses.resize(0);
  alone.parameters.setConstant(1e308);
  EXPECT_FALSE(certify(p, alone).reasons.empty());
  Answer not_finite = none;
  not_finite.objective = std::nan("");
  EXPECT_EQ(*why_unfit(p, not_finite), "a number of the answer is not finite");
}

/// 130 rows and a thousand shapes, all of it.
TEST(Certify, AThousandShapesOnThirteenLinks) {
  const StatedProblem p = test::body_problem(77);
  const auto solution = fast::solve_masses(p.masses);
  ASSERT_TRUE(solution);
  const Answer answer = honest_answer(p, solution->m);
  const auto start = std::chrono::steady_clock::now();
  const Certified c = certify(p, answer);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  fmt::print("certified in {:.2f} s\n", seconds.count());
  EXPECT_EQ(first_reason(c), "accepted");
  EXPECT_TRUE(c.proof.optimum_known);
}

}  // namespace
}  // namespace shapeid::certificate
