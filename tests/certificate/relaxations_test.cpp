// Least data terms over larger and larger sets: in order, near what other methods find, and not
// to be forged.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "shapeid/app/limit.hpp"
#include "shapeid/app/relaxed_optima.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"
#include "shapeid/proofs/certificate/exact_problem.hpp"
#include "shapeid/proofs/certificate/floor.hpp"
#include "shapeid/proofs/certificate/quadric.hpp"
#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/certificate/problems.hpp"
#include "shapeid/tests/certificate/verdict.hpp"
#include "shapeid/tests/support/generators.hpp"
#include "shapeid/tests/support/load_problem.hpp"
#include "shapeid/tests/support/relaxations.hpp"

namespace shapeid::certificate {
namespace {

constexpr double length = 0.1;  // m, about the size of everything here

/// Of the optimum over bodies, left open between its bounds: the barrier aims at 1e-9 and stops
/// where doubles do; 3e-6 was seen with thirteen links.
constexpr double open_share = 1e-5;

/// A small load in a flat box. With 5 % noise its unconstrained parameters are those of no body.
StatedProblem noisy_load(std::uint64_t seed, double noise) {
  test::Draw draw(seed);
  const Eigen::Vector3d lower(-0.15, -0.08, 0.075), upper(0.25, 0.12, 0.125);
  StatedProblem p{
      test::load_window(draw, 15, test::cuboid_body(1.0, {0.1, 0.03, 0.1}, {0.02, 0.03, 0.04}),
                        noise),
      {},
      {{0, make_cuboid(upper - lower, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0.02, 0.1)))}}};
  test::fill_with_cuboids(p.masses, lower, upper, {4, 2, 1});
  p.masses.lambda = default_lambda(p.masses, 1.0);
  p.masses.mass_bound = 10.0;
  return p;
}

Evidence sought(const StatedProblem& p) {
  return {app::limit_of_divisions(p), app::least_over_bodies(p), app::least_over_masses(p)};
}

Certified judged(const StatedProblem& p, const Evidence& evidence) {
  return certify(p, test::honest_answer(p, reference::solve_masses(p.masses).m), {}, evidence);
}

Rational data_term(const StatedProblem& p, const Eigen::VectorXd& Phi) {
  const ExactProblem exact_problem(p);
  return exact_problem.data_term(exact_problem.residual(exact(Phi), {}));
}

/// Whatever the residual, no body of at most the mass bound is below what follows from it.
RC_GTEST_PROP(BodiesFloor, NoBodyIsBelow, ()) {
  const StatedProblem p = noisy_load(*rc::gen::arbitrary<std::uint64_t>(), 0.05);
  const Evidence evidence{{}, app::least_over_bodies(p), {}};
  Eigen::VectorXd Phi = evidence.bodies.parameters;
  const double away = *test::magnitude(1e-9, 1.0);
  Phi += away * Phi.norm() * *test::vector(10, 1.0);
  const auto floor = floor_of_bodies(p, Phi, {});
  RC_CLASSIFY(!floor, "no floor");
  if (!floor) return;
  const double mass = *test::magnitude(1e-3, 10.0);
  const auto body = test::cuboid_body(mass, *test::vector3(0.3), {0.02, 0.05, 0.01});
  RC_ASSERT(*floor <= data_term(p, body.values));
  RC_ASSERT(*floor <= data_term(p, evidence.bodies.parameters));
}

/// The three numbers that exact arithmetic proves, next to what independent methods find in
/// doubles.
TEST(Relaxations, AreTightAndApartUnderNoise) {
  const StatedProblem p = noisy_load(0, 0.05);
  const Proof proof = judged(p, sought(p)).proof;
  const Ordered& of = proof.relaxations;
  fmt::print("masses {:.9g} {:.9g}, bodies {:.9g} {:.9g}, divisions {:.9g} {:.9g}, shapes {:.9g}\n",
             of.masses.lower, of.masses.upper, of.bodies.lower, of.bodies.upper, of.divisions.lower,
             of.divisions.upper, proof.lower);
  constexpr double rounding = 1e-12;
  const double masses = test::optimum_over_masses(p.masses);
  EXPECT_NEAR(of.masses.lower, masses, rounding * masses);
  EXPECT_EQ(of.masses.upper, std::nextafter(of.masses.lower, HUGE_VAL));
  const test::ConsistentOptimum bodies = test::optimum_over_bodies(p.masses, length);
  EXPECT_LT(of.bodies.upper - of.bodies.lower, open_share * of.bodies.upper);
  EXPECT_LE(bodies.lower, of.bodies.upper * (1.0 + rounding));
  EXPECT_LE(of.bodies.lower, bodies.upper * (1.0 + rounding));
  EXPECT_TRUE(of.apart[0]);
  EXPECT_TRUE(of.apart[1]);
  EXPECT_EQ(proof.floor, of.divisions.lower);
  EXPECT_LT(of.divisions.lower, proof.lower);
  EXPECT_LE(of.divisions.upper, proof.upper);
}

/// Where the unconstrained parameters are those of a body, being one costs nothing: nothing is
/// apart.
TEST(Relaxations, MeetWithoutNoise) {
  const StatedProblem p = noisy_load(1, 1e-4);
  const Ordered of = judged(p, sought(p)).proof.relaxations;
  EXPECT_FALSE(of.apart[0]);
  EXPECT_LE(of.masses.lower, of.bodies.lower);
  EXPECT_LE(of.masses.upper, of.bodies.upper);
}

/// No link's mass goes below zero, whichever link the rows would take it from.
TEST(Relaxations, NoLinkHasANegativeMass) {
  constexpr Eigen::Index links = 3;
  for (Eigen::Index link = 0; link < links; ++link) {
    StatedProblem p;
    p.masses.Y = Eigen::MatrixXd::Zero(links, 10 * links);
    p.masses.U = Eigen::MatrixXd::Zero(10 * links, links);
    for (Eigen::Index l = 0; l < links; ++l) p.masses.Y(l, 10 * l) = p.masses.U(10 * l, l) = 1.0;
    p.masses.F = Eigen::VectorXd::Ones(links);
    p.masses.F[link] = -2.0;
    p.masses.W = p.masses.V = Eigen::VectorXd::Ones(links);
    Guess guess{Eigen::VectorXd::Zero(10 * links), {}};
    for (Eigen::Index l = 0; l < links; ++l) guess.parameters[10 * l] = l == link ? 0.0 : 1.0;
    const Interval least = relaxations(p, {{}, {}, guess}, {}).masses;
    EXPECT_EQ(least.lower, 4);
    ASSERT_TRUE(least.upper);
    EXPECT_EQ(*least.upper, 4);
  }
}

/// A column that is the forces themselves explains as much of them as its bound lets it; the
/// optimum over masses is of degree two in what is left.
TEST(Relaxations, OtherColumnsKeepTheirBounds) {
  const StatedProblem alone = noisy_load(0, 0.05);
  const Guess guess = app::least_over_masses(alone);
  const Interval least = relaxations(alone, {{}, {}, guess}, {}).masses;
  ASSERT_GT(least.lower, 0);
  const double most = 0.3;
  const Rational left = 1 - exact(most);
  for (const double sign : {-1.0, 1.0}) {
    StatedProblem p = alone;
    p.others.values = sign * alone.masses.F;
    p.others.lower = Eigen::VectorXd::Constant(1, sign > 0.0 ? 0.0 : -most);
    p.others.upper = Eigen::VectorXd::Constant(1, sign > 0.0 ? most : 0.0);
    const Guess beside{(1.0 - most) * guess.parameters, Eigen::VectorXd::Constant(1, sign * most)};
    const Interval found = relaxations(p, {{}, {}, beside}, {}).masses;
    EXPECT_EQ(found.lower, Rational(left * left * least.lower));
  }
}

/// Thirteen coupled links: the barrier's path and the exact elimination at the size of a robot.
TEST(Relaxations, OfAWholeBody) {
  const StatedProblem p = test::body_problem(3);
  const Ordered of = judged(p, sought(p)).proof.relaxations;
  EXPECT_GT(of.bodies.lower, 0.0);
  EXPECT_LT(of.bodies.upper - of.bodies.lower, open_share * of.bodies.upper);
  EXPECT_LE(of.masses.upper, of.bodies.upper);
  EXPECT_GE(of.masses.upper, of.masses.lower);
}

/// Without evidence nothing is claimed that is not carried over from the shapes.
TEST(Relaxations, NothingFromNothing) {
  const StatedProblem p = noisy_load(0, 0.05);
  const Proof proof = judged(p, {}).proof;
  EXPECT_EQ(proof.relaxations.bodies.lower, 0.0);
  EXPECT_EQ(proof.relaxations.bodies.upper, proof.upper);
  EXPECT_EQ(proof.floor, std::nullopt);
}

/// Whatever is known of some sets: no lower bound is above that of a smaller set, and what a
/// smaller set reaches the larger ones do.
TEST(Relaxations, BoundsAreCarriedOver) {
  const StatedProblem p = noisy_load(0, 0.05);
  const Evidence all = sought(p);
  const auto below = [](const Interval& larger, const Interval& smaller) {
    const bool reached = !smaller.upper || (larger.upper && *larger.upper <= *smaller.upper);
    return larger.lower <= smaller.lower && reached;
  };
  for (const Evidence& evidence : {all, Evidence{{}, all.bodies, {}}, Evidence{{}, {}, all.masses},
                                   Evidence{all.limit, {}, {}}}) {
    for (const Interval& shapes : {Interval{}, Interval{exact(0.25), exact(1e6)}}) {
      const Relaxations of = relaxations(p, evidence, shapes);
      EXPECT_TRUE(below(of.masses, of.bodies));
      EXPECT_TRUE(below(of.bodies, of.divisions));
      EXPECT_TRUE(below(of.divisions, of.shapes));
      EXPECT_GT(of.shapes.lower, 0);
    }
  }
}

/// What a body reaches is only claimed of bodies that exist and that the mass bound allows.
TEST(Relaxations, ForgedBodiesReachNothing) {
  const StatedProblem p = noisy_load(0, 0.05);
  const Evidence honest = sought(p);
  const double reached = judged(p, honest).proof.relaxations.bodies.upper;
  const auto with_bodies = [&](const StatedProblem& problem, const Eigen::VectorXd& Phi) {
    return judged(problem, {honest.limit, {Phi, {}}, honest.masses}).proof;
  };
  // The unconstrained minimum is below every body, and none.
  const Eigen::VectorXd root = p.masses.W.cwiseSqrt();
  const Eigen::VectorXd none =
      (root.asDiagonal() * p.masses.Y).colPivHouseholderQr().solve(root.cwiseProduct(p.masses.F));
  EXPECT_LT(data_term(p, none), exact(reached));
  const Proof forged = with_bodies(p, none);
  EXPECT_EQ(forged.relaxations.bodies.upper, forged.upper);  // the shapes' own
  // A body that is heavier than the problem allows.
  StatedProblem lighter = p;
  lighter.masses.mass_bound = 0.5 * honest.bodies.parameters[0];
  EXPECT_GT(with_bodies(lighter, honest.bodies.parameters).relaxations.bodies.upper, reached);
  // Masses that are held although they should not be: the conditions see it.
  Guess held = honest.masses;
  held.parameters[0] = 0.0;
  const Proof wrong = judged(p, {honest.limit, honest.bodies, held}).proof;
  EXPECT_EQ(wrong.relaxations.masses.lower, 0.0);
}

/// A column that is no body's reaches what no body does: the floors count columns as written, so
/// the optimum of the stated problem is never below them.
TEST(Relaxations, ColumnsAsWrittenAreNotBelow) {
  StatedProblem p = noisy_load(0, 0.05);
  const Evidence evidence = sought(p);
  const Proof honest = judged(p, evidence).proof;
  const Eigen::VectorXd root = p.masses.W.cwiseSqrt();
  const Eigen::VectorXd none =
      (root.asDiagonal() * p.masses.Y).colPivHouseholderQr().solve(root.cwiseProduct(p.masses.F));
  ASSERT_GT(none[0], 0.0);
  p.masses.U.col(0) = none / none[0];
  const Proof proof = judged(p, evidence).proof;
  EXPECT_LT(proof.upper, honest.relaxations.bodies.lower);
  EXPECT_LE(proof.relaxations.bodies.lower, proof.upper);
  EXPECT_LE(proof.relaxations.divisions.lower, proof.upper);
}

/// Columns of three kilograms a unit of mass: within the bound on the mass that is counted, shapes
/// reach what no parameters of at most that mass do.
TEST(Relaxations, ColumnsThatWeighMoreReachNothingForTheLargerSets) {
  StatedProblem p;
  p.masses.Y = Eigen::MatrixXd::Zero(1, 10);
  p.masses.U = Eigen::MatrixXd::Zero(10, 1);
  p.masses.Y(0, 0) = 1.0;
  p.masses.F = Eigen::VectorXd::Constant(1, 3.0);
  p.masses.W = p.masses.V = Eigen::VectorXd::Ones(1);
  p.masses.mass_bound = 1.0;
  const auto upper_of_masses = [&](double kilograms) {
    p.masses.U(0, 0) = kilograms;
    const double left = kilograms - 3.0;  // of the force, with a mass of one
    return relaxations(p, {}, {0, exact(left * left)}).masses.upper;
  };
  EXPECT_EQ(upper_of_masses(1.0), std::optional<Rational>(4));
  EXPECT_EQ(upper_of_masses(3.0), std::nullopt) << "one kilogram leaves 4 of the data term";
  p.masses.mass_bound = 0.0;
  EXPECT_EQ(upper_of_masses(3.0), std::optional<Rational>(0));
}

/// A forger who changes evidence or claims and names the right digests meets the mathematics.
TEST(Relaxations, DigestsMadeGoodDoNotHelp) {
  const StatedProblem p = noisy_load(0, 0.05);
  const Answer answer = test::honest_answer(p, reference::solve_masses(p.masses).m);
  const Evidence evidence = sought(p);
  const Proof proof = certify(p, answer, {}, evidence).proof;
  const auto refused = [&](const nlohmann::json& certificate) {
    const Certificate read = certificate_from_json(certificate.dump(), "certificate.json", p);
    return !false_claims(read, certify(p, answer, {}, read.evidence).proof).empty();
  };
  const auto good = nlohmann::json::parse(certificate_to_json(proof, evidence));
  EXPECT_FALSE(refused(good));
  for (const char* set : {"limit", "bodies", "masses"}) {
    for (Eigen::Index i = 0; i < 10; ++i) {
      Evidence shaken = evidence;
      Guess& guess = set == std::string("limit")    ? shaken.limit
                     : set == std::string("bodies") ? shaken.bodies
                                                    : shaken.masses;
      guess.parameters[i] += 1e-3 * evidence.bodies.parameters.norm();
      nlohmann::json forged = nlohmann::json::parse(certificate_to_json(proof, shaken));
      // Where masses are sought exactly, the guess only says which are held.
      const bool start_only = set == std::string("masses");
      EXPECT_EQ(refused(forged), !start_only) << set << i;
    }
  }
}

RC_GTEST_PROP(Quadric, NoPointOfSpaceIsLower, ()) {
  Eigen::VectorXd slope = *test::vector(10, 1.0);
  const double upwards = *rc::gen::element(0.0, 2.0);
  for (const int moment : {4, 7, 9}) slope[moment] += upwards;
  const Quadric q = cost_of_point(exact(slope));
  const auto lowest = lowest_in_space(q);
  RC_CLASSIFY(!lowest, "without a floor");
  for (int k = 0; k < 20 && lowest; ++k) {
    const Vector x = exact(*test::vector(3, 100.0));
    RC_ASSERT(*lowest <= q.at(x));
  }
}

TEST(Quadric, FloorsInSpace) {
  const auto lowest = [](const Vector& g) { return lowest_in_space(cost_of_point(g)); };
  // |x|^2 - 2 x - 3 has its minimum -4 at (1, 0, 0); the inertias cost y^2 + z^2 and so on.
  const Rational half(1, 2);
  EXPECT_EQ(lowest({-3, -2, 0, 0, half, 0, 0, half, 0, half}), Rational(-4));
  EXPECT_EQ(lowest({5, -2, 0, 0, half, 0, 0, half, 0, half}), Rational(0));
  EXPECT_EQ(lowest({0, 0, 0, 0, 0, 0, 0, 0, 0, 1}), Rational(0));    // x^2 + y^2
  EXPECT_EQ(lowest({0, 0, 0, 1, 0, 0, 0, 0, 0, 1}), std::nullopt);   // x^2 + y^2 + z
  EXPECT_EQ(lowest({1, 0, 0, 0, 1, 0, 0, 1, 0, -2}), std::nullopt);  // falls along x and y
  EXPECT_EQ(lowest({-1, 0, 0, 0, 0, 0, 0, 0, 0, 0}), std::nullopt);  // a constant below zero
  EXPECT_EQ(lowest({1, 2, 0, 0, 0, 0, 0, 1, 0, 1}).has_value(), true);
}

}  // namespace
}  // namespace shapeid::certificate
