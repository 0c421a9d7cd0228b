// Both paths on logs of real robots. The data lie outside the project; without them the tests say
// so and check nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/fast/window.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/fast/expected_rows.hpp"

namespace shapeid {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::filesystem::path data(const std::string& file) {
  const char* const folder = std::getenv("SHAPEID_DATA");
  return std::filesystem::path(folder != nullptr ? folder : SHAPEID_SOURCE_DIR "/../shared/data") /
         file;
}

bool absent(const std::string& file) {
  if (std::filesystem::exists(data(file))) return false;
  fmt::print("skipped: {} is not there (set SHAPEID_DATA)\n", data(file).string());
  return true;
}

struct Log {
  Robot robot;
  std::vector<Sample> samples;  ///< of its beginning
};

Log log_of(const std::string& urdf, Root root, const std::string& file, const std::string& mapping,
           std::size_t most) {
  UrdfOptions options;
  options.root = root;
  options.reject_impossible = false;
  Log log{read_urdf(data(urdf), options).robot, {}};
  const Mapping map =
      read_mapping_yaml(SHAPEID_SOURCE_DIR "/docs/examples/" + mapping + ".mapping.yaml");
  if (root == Root::floating) add_default_contacts(log.robot, data(file), map);
  MotionReader reader(data(file), log.robot, {}, map, {});
  while (log.samples.size() < most) {
    std::optional<Sample> sample = reader.next();
    if (!sample) break;
    log.samples.push_back(*sample);
  }
  return log;
}

/// Windows of ten samples, one after the other; prints what paths they took.
void compare_windows(const Log& log, const BodyModel& model, ContactTreatment contacts) {
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
  if (absent(file)) return;
  const Log log = log_of(folder + "mini_cheetah_from_mit_constants.urdf", Root::floating, file,
                         "mini_cheetah", 3000);
  ASSERT_EQ(log.robot.contacts.size(), 4U);
  fmt::print("{}\n", file);
  compare_windows(log, test::base_model(log.robot), ContactTreatment::project);
}

INSTANTIATE_TEST_SUITE_P(Logs, FastMeasured,
                         testing::Values("air_walking_gait_val", "concrete_right_circle_test",
                                         "concrete_galloping_val", "small_pebble_val"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(FastMeasuredRobots, WholeMiniCheetahAsTheReference) {
  const std::string folder = "mini_cheetah_umich/", file = folder + "concrete_galloping_val.csv.gz";
  if (absent(file)) return;
  const Log log = log_of(folder + "mini_cheetah_from_mit_constants.urdf", Root::floating, file,
                         "mini_cheetah", 600);
  compare_windows(log, test::whole_model(log.robot), ContactTreatment::project);
}

TEST(FastMeasuredRobots, ArmOnAFixedBaseAsTheReference) {
  const std::string folder = "ur10e_load/", file = folder + "ur-20_02_19_14harm50sec.csv.gz";
  if (absent(file)) return;
  const Log log = log_of(folder + "ur10e.urdf", Root::fixed, file, "ur10e", 1000);
  compare_windows(log, test::whole_model(log.robot), ContactTreatment::ignore);
}

}  // namespace
}  // namespace shapeid
