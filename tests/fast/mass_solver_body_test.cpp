// Whole bodies, up to 13 links with 50 shapes each, by the fast solver and by the reference.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fmt/format.h>

#include <string>

#include "shapeid/reference/mass_solver.hpp"
#include "shapeid/tests/fast/agreement.hpp"
#include "shapeid/tests/fast/triangle_cases.hpp"

namespace shapeid {
namespace {

using test::BodyStyle;
using test::Tally;
using test::TriangleCase;

std::string difference(const TriangleCase& given, Tally& tally) {
  fast::MassSolver solver(given.link_count(), given.shapes());
  load(given, solver);
  if (solver.solve(given.R) != fast::Outcome::solved) {
    tally.count_declined();
    return {};
  }
  const MassSolution reference = reference::solve_masses(given.problem);
  const test::Agreement here = agreement(given, solver, reference.m);
  tally.count(here, solver.iterations());
  return why_not_equal(here, given, solver);
}

TriangleCase any_body(bool density_term) {
  BodyStyle style;
  style.links = *rc::gen::inRange(1, 6);
  style.shapes_a_link = *rc::gen::inRange(0, 16);
  style.samples = *rc::gen::inRange(0, 12);  // down to fewer rows than parameters
  style.noise = *rc::gen::element(0.0, 1e-6, 1e-2, 0.3);
  style.density_term = density_term;
  return test::body_case(*rc::gen::arbitrary<std::uint64_t>(), style);
}

RC_GTEST_PROP(FastBodies, AsTheReference, ()) {
  static Tally tally("bodies");
  const std::string found = difference(any_body(true), tally);
  if (!found.empty()) RC_FAIL(found);
  RC_ASSERT(tally.declined() == 0);
}

RC_GTEST_PROP(FastBodies, AsTheReferenceWithoutDensityTerm, ()) {
  static Tally tally("bodies, lambda = 0");
  const std::string found = difference(any_body(false), tally);
  if (!found.empty()) RC_FAIL(found);
  RC_ASSERT(tally.declined() == 0);
}

/// With Phi unique, the parameters agree one by one: to roundings of the length of each column of
/// R, times the inverse of the margin by which the columns are independent.
TEST(FastBodies, ParametersAreThoseOfTheReferenceWithoutDensityTerm) {
  int determined = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const TriangleCase given =
        test::body_case(seed, {.links = 2, .shapes_a_link = 20, .density_term = false});
    if (!determines_parameters(given)) continue;
    ++determined;
    fast::MassSolver solver(given.link_count(), given.shapes());
    load(given, solver);
    ASSERT_EQ(solver.solve(given.R), fast::Outcome::solved);
    const Eigen::VectorXd expected = reference::solve_masses(given.problem).Phi;
    const Eigen::VectorXd lengths = given.problem.Y.colwise().norm();
    const double difference = (solver.Phi() - expected).cwiseProduct(lengths).norm();
    test::keep_worst(worst, difference / given.problem.F.norm());
  }
  fmt::print("Phi of {} problems, worst difference {:.1e}\n", determined, worst);
  EXPECT_GT(determined, 20);
  EXPECT_LT(worst, test::promised_slope);
}

TEST(FastBodies, ThirteenLinks) {
  Tally damped("13 links"), undamped("13 links, lambda = 0");
  for (const int shapes : {4, 8, 16, 50}) {
    SCOPED_TRACE(shapes);
    for (const bool density_term : {true, false}) {
      const TriangleCase given = test::body_case(
          7 + static_cast<std::uint64_t>(shapes),
          {.links = 13, .shapes_a_link = shapes, .noise = 1e-2, .density_term = density_term});
      EXPECT_EQ(difference(given, density_term ? damped : undamped), "");
    }
  }
  EXPECT_EQ(damped.declined() + undamped.declined(), 0);
}

}  // namespace
}  // namespace shapeid
