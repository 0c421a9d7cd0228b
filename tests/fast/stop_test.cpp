// Both paths end their divisions at the same place, with a floor and without.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "shapeid/fast/division.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/reference/division.hpp"
#include "shapeid/tests/support/planar_load.hpp"

namespace shapeid {
namespace {

std::string words(fast::Division::Stop stop) {
  switch (stop) {
    case fast::Division::Stop::step:
      return "step";
    case fast::Division::Stop::limit:
      return "limit";
    case fast::Division::Stop::nothing_divisible:
      return "nothing divisible";
    case fast::Division::Stop::declined:
      return "declined";
  }
  return "";
}

/// No floor, floors that end runs in small parts or after a while, and one that is reached at once.
TEST(FastDivision, EndsWhereTheReferenceDoes) {
  for (const double noise : {0.02, 0.2}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      test::ModelWithRows given = test::planar_load(seed, noise);
      // Halves on either side of the plane are alike, and which is divided must not be left to
      // rounding: the density term settles it.
      given.problem.lambda *= 1e6;
      const DivisionOptions options{.expected_mass = given.expected_mass};
      fast::Triangle triangle(given.problem.Y.cols());
      triangle.add(given.problem.Y, given.problem.F);
      fast::Division run(given.model, options);
      run.set_lambda(given.problem.lambda);
      const double undivided =
          reference::divide_and_solve(given.model, given.problem,
                                      {.most_divisions = 0, .expected_mass = 1.0})
              .solution.value.total();
      for (const double share : {-1.0, 0.0, 0.9, 1.0}) {
        SCOPED_TRACE(fmt::format("noise {}, seed {}, floor {}", noise, seed, share));
        std::optional<double> floor;
        std::function<double(const reference::DivisionRun&)> asked;
        if (share >= 0.0) {
          floor = share * undivided;
          asked = [&](const reference::DivisionRun&) { return *floor; };
        }
        const auto expected =
            reference::divide_and_solve(given.model, given.problem, options, {}, asked);
        ASSERT_EQ(run.start(triangle.R(), fast::Division::Start::no_masses), fast::Outcome::solved);
        EXPECT_EQ(words(run.run(floor)), expected.stopped_by);
        EXPECT_EQ(run.history().size(), expected.history.size());
      }
    }
  }
}

}  // namespace
}  // namespace shapeid
