// diagnose on a measured log, which no test of simulated ones stands for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::test {
namespace {

std::string mini_cheetah() { return (data_folder() / "mini_cheetah_umich").string() + "/"; }

bool has_mini_cheetah() {
  return std::filesystem::exists(mini_cheetah() + "small_pebble_val.csv.gz");
}

std::string example(const std::string& name) {
  return (std::filesystem::path(SHAPEID_SOURCE_DIR) / "docs" / "examples" / name).string();
}

/// Of a run on one ground its first log, tested on the other.
CommandRun diagnose_mini_cheetah(
    const std::string& ground, const std::string& options,
    const std::string& mapping = example("mini_cheetah.mapping.yaml")) {
  return shapeid(
      fmt::format("diagnose --robot {0}mini_cheetah_from_mit_constants.urdf --accept-impossible "
                  "--mapping {1} --log {0}{2}_val.csv.gz --test {0}{2}_test.csv.gz {3}",
                  mini_cheetah(), mapping, ground, options));
}

/// A mapping with the position of a joint of the other sign.
std::string with_other_sign(const std::string& mapping, const std::string& joint) {
  std::string text = text_of(example(mapping));
  for (const char* column : {"q.", "dq."}) {
    const std::string name = "\n  " + (column + joint) + ": ";
    const std::size_t begin = text.find(name) + name.size(), end = text.find('\n', begin);
    text.replace(begin, end - begin,
                 fmt::format("{{from: {}, sign: -1}}", text.substr(begin, end - begin)));
  }
  return text;
}

/// Standing feet of this robot slip but for a few in a hundred, and these tell. An external force
/// was found in its place before.
TEST(MeasuredDiagnosis, AnImuThatIsTurnedAboutTheVerticalIsRefused) {
  if (!has_mini_cheetah()) GTEST_SKIP() << mini_cheetah() << " is not there (set SHAPEID_DATA)";
  const ScratchFolder scratch;
  scratch.write("turned.robot.yaml", "imu: {rpy: [0, 0, 1.5707963267948966]}\n");
  for (const char* ground : {"asphalt_road", "middle_pebble", "concrete_right_circle"}) {
    const CommandRun run =
        diagnose_mini_cheetah(ground, "--robot-yaml " + scratch.path("turned.robot.yaml"));
    EXPECT_EQ(run.status, 1) << ground;
    EXPECT_NE(run.err.find("refused (imu-axes)"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("if its axes were (y, -x, z)"), std::string::npos) << run.err;
  }
}

/// A knee by the given links and feet that stand; a Panda's joint by masses that are fitted, for of
/// this one no inertias are given.
TEST(MeasuredDiagnosis, AJointOfTheOtherSignIsRefused) {
  if (!has_mini_cheetah()) GTEST_SKIP() << mini_cheetah() << " is not there (set SHAPEID_DATA)";
  const ScratchFolder scratch;
  const std::string knee =
      scratch.write("knee.yaml", with_other_sign("mini_cheetah.mapping.yaml", "FR_knee"));
  const CommandRun trot = diagnose_mini_cheetah("asphalt_road", "", knee);
  EXPECT_EQ(trot.status, 1);
  EXPECT_NE(trot.err.find("refused (joint-sign): the given model"), std::string::npos) << trot.err;
  EXPECT_NE(trot.err.find("(FR_knee position of the other sign,"), std::string::npos) << trot.err;

  const std::string joint =
      scratch.write("joint.yaml", with_other_sign("panda.mapping.yaml", "panda_joint3"));
  const CommandRun arm = shapeid(fmt::format(
      "diagnose --robot {} --log {} --mapping {} --cutoff 10 --expected-mass 18",
      example("panda.urdf"),
      (data_folder() / "franka_panda" / "panda_exciting_traj1_first_half.csv.gz").string(), joint));
  EXPECT_EQ(arm.status, 1);
  EXPECT_NE(arm.err.find("refused (joint-sign): masses that are fitted"), std::string::npos)
      << arm.err;
  EXPECT_NE(arm.err.find("(panda_joint3 position of the other sign)"), std::string::npos)
      << arm.err;
}

/// A Mini Cheetah that hangs from what no channel knows: its rotors are found, its body is not.
TEST(MeasuredDiagnosis, OfALogThatAsksForNoMassThatIsSaid) {
  if (!has_mini_cheetah()) GTEST_SKIP() << mini_cheetah() << " is not there (set SHAPEID_DATA)";
  const CommandRun run =
      shapeid(fmt::format("diagnose --robot {0}mini_cheetah_from_mit_constants.urdf "
                          "--accept-impossible --mapping {1} --log {0}air_jumping_gait_val.csv.gz "
                          "--also {0}air_jumping_gait_test.csv.gz "
                          "--test {0}air_walking_gait_val.csv.gz",
                          mini_cheetah(), example("mini_cheetah.mapping.yaml")));
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("note: the log asks for no mass at all where some is sought"),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("rotor_inertia@FR_knee"), std::string::npos) << run.out;
}

/// A Mini Cheetah on small pebbles: of two delays, both large, that of the IMU is sought at more
/// than 18 ms while little else is known, which is not believed. It may come in once more: beside
/// all else it is 16 to 17 ms, and without it the error on the other log is a fifth larger.
TEST(MeasuredDiagnosis, ADelayThatWasTooLargeAtFirstIsSoughtAgain) {
  if (!has_mini_cheetah()) GTEST_SKIP() << mini_cheetah() << " is not there (set SHAPEID_DATA)";
  const CommandRun run = diagnose_mini_cheetah("small_pebble", "--json");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  const auto& findings = result["findings"];
  const auto delay = std::find_if(findings.begin(), findings.end(),
                                  [](const auto& f) { return f["effect"] == "imu_delay"; });
  ASSERT_NE(delay, findings.end()) << findings.dump(2);
  EXPECT_GT((*delay)["value"].get<double>(), 0.014);
  EXPECT_LT((*delay)["value"].get<double>(), 0.018);
}

/// The torques that were commanded, in place of those that the drives say: in some runs none was
/// asked of one of the two joints, which swung as the other one moved it.
TEST(MeasuredDiagnosis, ATorqueOfZeroIsRightOfAJointThatNothingDrives) {
  const std::string folder =
      (data_folder() / "double_pendulum").string() + "/design_C.0__20220914_";
  if (!std::filesystem::exists(folder + "03.csv.gz")) {
    GTEST_SKIP() << folder << "03.csv.gz is not there (set SHAPEID_DATA)";
  }
  const ScratchFolder scratch;
  const std::string mapping = scratch.write(
      "mapping.yaml",
      "columns: {time: t_s, q.shoulder: q1_rad, q.elbow: q2_rad, dq.shoulder: dq1_radps, "
      "dq.elbow: dq2_radps, tau.shoulder: taucmd1_Nm, tau.elbow: taucmd2_Nm}\n"
      "torque: {kind: joint}\n");
  for (const auto& [run, joint] : {std::pair{"03", "shoulder"}, std::pair{"05", "elbow"}}) {
    const CommandRun result = shapeid(fmt::format(
        "diagnose --robot {}/docs/examples/double_pendulum_c.urdf --mapping {} --log {}{}.csv.gz",
        SHAPEID_SOURCE_DIR, mapping, folder, run));
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find(fmt::format("is zero in every row while {} moves", joint)),
              std::string::npos)
        << result.out;
    // All that is predicted is residual there.
    EXPECT_EQ(result.out.find(fmt::format("\n  {0:<24}over tau.{0}", joint)), std::string::npos)
        << result.out;
  }
}

/// A double pendulum of direct drives: drag, an encoder's offset and more come in before the dry
/// friction of both drives, none of which stands then. The search that begins with what is usually
/// fitted ends elsewhere: on the other runs 0.189 N m, where the first one has 0.225 and the usual
/// fit 0.189 to 0.192.
TEST(MeasuredDiagnosis, FrictionIsFoundByTheSearchThatBeginsWithIt) {
  const std::string folder =
      (data_folder() / "double_pendulum").string() + "/design_A.0__20220815_";
  if (!std::filesystem::exists(folder + "00.csv.gz")) {
    GTEST_SKIP() << folder << "00.csv.gz is not there (set SHAPEID_DATA)";
  }
  const CommandRun run = shapeid(fmt::format(
      "diagnose --robot {1}/double_pendulum.urdf --mapping {1}/double_pendulum.mapping.yaml "
      "--log {0}00.csv.gz --also {0}02.csv.gz {0}04.csv.gz "
      "--test {0}01.csv.gz {0}03.csv.gz {0}05.csv.gz --cutoff 8 --json",
      folder, (std::filesystem::path(SHAPEID_SOURCE_DIR) / "docs" / "examples").string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out);
  double square = 0.0;
  for (const double joint : result["heldout_rms_after"]) square += joint * joint;
  EXPECT_LT(std::sqrt(square), 0.2);
  for (const std::string joint : {"shoulder", "elbow"}) {
    const bool found = std::ranges::any_of(result["findings"], [&joint](const auto& f) {
      return f["effect"] == "coulomb_friction" && f["site"] == joint;
    });
    EXPECT_TRUE(found) << joint << result["findings"].dump(2);
  }
}

}  // namespace
}  // namespace shapeid::test
