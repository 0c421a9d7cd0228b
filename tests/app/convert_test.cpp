// shapeid convert: there and back, from the command line and from standard input.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

// About the origin; all different, so that none can stand for another. Dyadic: moving them about
// the centre of mass (0.25, -0.5, 0.75) rounds nothing.
const std::string pinocchio = "2 0.5 -1 1.5 4 0.125 5 -0.375 0.25 6";

TEST(Convert, GoesThereAndBack) {
  for (const std::string other : {"idyntree", "drake", "mujoco", "urdf", "spatial_v2", "symoro"}) {
    const CommandRun there =
        shapeid(fmt::format("convert --from pinocchio --to {} {}", other, pinocchio));
    ASSERT_EQ(there.status, 0) << there.err;
    EXPECT_NE(there.out, pinocchio + "\n") << other;
    const CommandRun back = shapeid(fmt::format("convert --from {} --to pinocchio {}", other,
                                                there.out.substr(0, there.out.size() - 1)));
    EXPECT_EQ(back.status, 0) << back.err;
    EXPECT_EQ(back.out, pinocchio + "\n") << other;
  }
}

TEST(Convert, KnowsWhichPlacesTheLibrariesExchange) {
  // iDynTree keeps Ixz before Iyy, Pinocchio Iyy before Ixz.
  const CommandRun run = shapeid("convert --from pinocchio --to idyntree " + pinocchio);
  EXPECT_EQ(run.out, "2 0.5 -1 1.5 4 0.125 -0.375 5 0.25 6\n") << run.err;
}

TEST(Convert, ReadsStandardInput) {
  const std::string file = scratch_file("numbers.txt", "  2 0.5\n-1 1.5 4\t0.125 5 -0.375 0.25 6");
  const CommandRun run = shapeid("convert --from pinocchio --to idyntree", file);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, "2 0.5 -1 1.5 4 0.125 -0.375 5 0.25 6\n");
  const CommandRun wrong =
      shapeid("convert --from pinocchio --to idyntree", scratch_file("few.txt", "2 0.5 x"));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("\"x\""), std::string::npos) << wrong.err;
}

/// A word that is longer than any number is not cut into two.
TEST(Convert, RefusesWordsThatAreTooLong) {
  const std::string zeros(500, '0');
  expect_one_line(shapeid("convert --from pinocchio --to drake",
                          scratch_file("long.txt", "2 0.5 -1 1.5 4 0.125 5 -0.375 0." + zeros)),
                  2, "has a number of 400 digits and more");
}

/// Numbers without an end, and one that has none, are not waited for.
TEST(Convert, DoesNotReadOnForEver) {
  for (const std::string endless : {"yes 1", "yes 1 | tr -d '\\n'"}) {
    const CommandRun run = program(in_bash(endless + " | head -c 100000000 | " +
                                           command("convert --from pinocchio --to drake")));
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_LT(run.err.size(), 300U);
  }
}

/// Moments whose sums are no numbers any more are of no body.
TEST(Convert, RefusesWhatOverflows) {
  const CommandRun run =
      shapeid("convert --from pinocchio --to drake 1e308 1e308 1e308 1e308 1 0 1 0 0 1");
  expect_one_line(run, 2, "too large");
}

/// As in a URDF.
TEST(Convert, RefusesAnglesInDegrees) {
  const std::string urdf = "convert --from urdf --to pinocchio -- 2 0 0 0 0 ";
  expect_one_line(shapeid(urdf + "-90 0 1 0 0 1 0 1"), 2,
                  "roll, pitch or yaw turns by 90; radians, a turn at most");
  EXPECT_EQ(shapeid(urdf + "-6.2831853071795862 0 1 0 0 1 0 1").status, 0);
}

TEST(Convert, SaysWhetherABodyCanHaveThem) {
  const CommandRun good = shapeid("convert --json --from pinocchio --to idyntree " + pinocchio);
  ASSERT_EQ(good.status, 0) << good.err;
  EXPECT_EQ(good.err, "");
  const auto document = nlohmann::json::parse(good.out);
  EXPECT_EQ(document["order"], "idyntree");
  EXPECT_EQ(document["possible"], true);
  EXPECT_EQ(document["numbers"].get<std::vector<double>>(),
            (std::vector<double>{2, 0.5, -1, 1.5, 4, 0.125, -0.375, 5, 0.25, 6}));

  const CommandRun bad =
      shapeid("convert --json --from pinocchio --to idyntree 2 0 0 0 1 0 1 0 0 5");
  EXPECT_EQ(bad.status, 0) << bad.err;
  EXPECT_EQ(nlohmann::json::parse(bad.out)["possible"], false);
  EXPECT_EQ(bad.err.find("warning: no body can have these parameters: "), 0U) << bad.err;
}

}  // namespace
}  // namespace shapeid::test
