// diagnose on a measured log, which no test of simulated ones stands for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

/// A Mini Cheetah on small pebbles: of two delays, both large, that of the IMU is sought at more
/// than 18 ms while little else is known, which is not believed. It may come in once more: beside
/// all else it is 16 to 17 ms, and without it the error on the other log is a fifth larger.
TEST(MeasuredDiagnosis, ADelayThatWasTooLargeAtFirstIsSoughtAgain) {
  const std::string folder = (data_folder() / "mini_cheetah_umich").string() + "/";
  if (!std::filesystem::exists(folder + "small_pebble_val.csv.gz")) {
    GTEST_SKIP() << folder << " is not there (set SHAPEID_DATA)";
  }
  const CommandRun run = shapeid(
      fmt::format("diagnose --robot {0}mini_cheetah_from_mit_constants.urdf --accept-impossible "
                  "--mapping {1}/docs/examples/mini_cheetah.mapping.yaml "
                  "--log {0}small_pebble_val.csv.gz --test {0}small_pebble_test.csv.gz --json",
                  folder, SHAPEID_SOURCE_DIR));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto& findings = result["findings"];
  const auto delay = std::find_if(findings.begin(), findings.end(),
                                  [](const auto& f) { return f["effect"] == "imu_delay"; });
  ASSERT_NE(delay, findings.end()) << findings.dump(2);
  EXPECT_GT((*delay)["value"].get<double>(), 0.014);
  EXPECT_LT((*delay)["value"].get<double>(), 0.018);
}

}  // namespace
}  // namespace shapeid::test
