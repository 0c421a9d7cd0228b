// Both paths on logs of real robots. The data lie outside the project; without them the tests are
// skipped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "shapeid/fast/window.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/expected_rows.hpp"
#include "shapeid/tests/fast/measured_logs.hpp"
#include "shapeid/tests/fast/window_runs.hpp"
#include "shapeid/tests/support/scaled.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Windows of ten samples, one after the other; prints what paths they took.
void compare_windows(const test::Log& log, const BodyModel& model, ContactTreatment contacts) {
  constexpr std::size_t length = 10;
  const VectorXd weight = VectorXd::Ones(log.robot.dof());
  fast::Window fast_window(log.robot, model, contacts, weight);
  reference::Window window(log.robot, model, contacts, weight);
  std::size_t windows = 0, six_rows = 0;
  for (std::size_t first = 0; first + length <= log.samples.size(); first += length, ++windows) {
    fast_window.clear();
    window.clear();
    test::ExpectedRows expected;
    for (std::size_t k = first; k < first + length; ++k) {
      const Sample& s = log.samples[k];
      ASSERT_EQ(fast_window.add(s), fast::Verdict::taken);
      window.add(s);
      const auto rows = test::expected_rows(log.robot, model, contacts, weight, s);
      expected.rounding = k == first ? rows.rounding : expected.rounding + rows.rounding;
    }
    six_rows += fast_window.samples_by_six_rows();
    MatrixXd YF(window.Y().rows(), window.Y().cols() + 1);
    YF << window.Y(), window.F();
    expected.gram = YF.transpose() * YF;
    const MatrixXd& R = fast_window.triangle().R();
    ASSERT_EQ(test::first_difference(R.transpose() * R, expected, log.robot, log.samples[first]),
              std::string());
  }
  fmt::print("  {} windows, {} samples by six rows, {} by the general path\n", windows, six_rows,
             length * windows - six_rows);
  EXPECT_GT(windows, 50U);
}

class FastMeasured : public testing::TestWithParam<const char*> {};

TEST_P(FastMeasured, MiniCheetahsBaseAsTheReference) {
  const std::string folder = "mini_cheetah_umich/", file = folder + GetParam() + ".csv.gz";
  if (test::absent(file)) GTEST_SKIP() << file << " is not there (set SHAPEID_DATA)";
  const test::Log log = test::log_of(folder + "mini_cheetah_from_mit_constants.urdf",
                                     Root::floating, file, "mini_cheetah", 3000);
  ASSERT_EQ(log.robot.contacts.size(), 4U);
  fmt::print("{}\n", file);
  compare_windows(log, test::base_model(log.robot), ContactTreatment::project);
}

TEST_P(FastMeasured, MiniCheetahsWindowsAsTheReferenceSolvesThem) {
  const std::string folder = "mini_cheetah_umich/", file = folder + GetParam() + ".csv.gz";
  if (test::absent(file)) GTEST_SKIP() << file << " is not there (set SHAPEID_DATA)";
  const test::Log log = test::log_of(folder + "mini_cheetah_from_mit_constants.urdf",
                                     Root::floating, file, "mini_cheetah", 2000);
  fast::IdentifierSettings settings;
  settings.expected_mass = log.robot.links[0].inertia.mass();
  const test::WindowRuns runs =
      test::run_windows(log.robot, test::base_model(log.robot), settings, log.samples);
  fmt::print("{}\n  {}\n", file, describe(runs));
  EXPECT_EQ(runs.first_wrong, "");
  EXPECT_GT(runs.windows, 10 * runs.declined);
  EXPECT_LT(runs.worst_objective, test::few_hundred_eps);
  EXPECT_LT(runs.worst_filter, test::few_hundred_eps);
}

INSTANTIATE_TEST_SUITE_P(Logs, FastMeasured,
                         testing::Values("air_walking_gait_val", "concrete_right_circle_test",
                                         "concrete_galloping_val", "small_pebble_val"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(FastMeasuredRobots, WholeMiniCheetahAsTheReference) {
  const std::string folder = "mini_cheetah_umich/", file = folder + "concrete_galloping_val.csv.gz";
  if (test::absent(file)) GTEST_SKIP() << file << " is not there (set SHAPEID_DATA)";
  const test::Log log = test::log_of(folder + "mini_cheetah_from_mit_constants.urdf",
                                     Root::floating, file, "mini_cheetah", 600);
  compare_windows(log, test::whole_model(log.robot), ContactTreatment::project);
}

TEST(FastMeasuredRobots, ArmOnAFixedBaseAsTheReference) {
  const std::string folder = "ur10e_load/", file = folder + "ur-20_02_19_14harm50sec.csv.gz";
  if (test::absent(file)) GTEST_SKIP() << file << " is not there (set SHAPEID_DATA)";
  const test::Log log = test::log_of(folder + "ur10e.urdf", Root::fixed, file, "ur10e", 1000);
  compare_windows(log, test::whole_model(log.robot), ContactTreatment::ignore);
}

}  // namespace
}  // namespace shapeid
