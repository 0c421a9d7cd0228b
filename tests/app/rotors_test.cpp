// Rotors of robot.yaml: what simulate logs, the fit takes off again.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/models/log.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

constexpr double motor_inertia = 6e-5, gear = 9.0;

class Rotors : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string notes = text_of(robots + "quadruped.robot.yaml");
    scratch_file("plain.yaml", notes);
    scratch_file("rotors.yaml",
                 notes + fmt::format("\nrotors: {{FR_knee: {{inertia: {}, gear: {}}}, RL_hip: "
                                     "{{inertia: 2e-5, gear: {}}}}}\n",
                                     motor_inertia, gear, gear));
    for (const char* name : {"plain", "rotors"}) {
      ASSERT_EQ(shapeid(fmt::format("simulate --robot {}quadruped.urdf --robot-yaml {}.yaml "
                                    "--seconds 3 --exact --out {}.csv",
                                    robots, name, name))
                    .status,
                0);
    }
  }

  static nlohmann::json identified(const std::string& log, const std::string& notes) {
    const CommandRun run = shapeid(
        fmt::format("identify --robot {}quadruped.urdf --robot-yaml {}.yaml --log {}.csv {} "
                    "--exact --divisions 0 --json",
                    robots, notes, log, quadruped_shapes));
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(run.out);
  }
};

std::size_t column(const LogReader& log, const std::string& name) {
  const auto& names = log.columns();
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

TEST_F(Rotors, TakeTheirInertiaTimesTheGearSquaredTimesTheAcceleration) {
  LogReader plain(scratch() + "/plain.csv"), with(scratch() + "/rotors.csv");
  double most = 0.0;
  while (const std::optional<LogRow> row = plain.next()) {
    const std::optional<LogRow> other = with.next();
    ASSERT_TRUE(other);
    for (std::size_t i = 0; i < row->values.size(); ++i) {
      const std::string& name = plain.columns()[i];
      double taken = 0.0;
      if (name == "tau.FR_knee") taken = motor_inertia * row->values[column(plain, "ddq.FR_knee")];
      if (name == "tau.RL_hip") taken = 2e-5 * row->values[column(plain, "ddq.RL_hip")];
      taken *= gear * gear;
      const double size = std::abs(row->values[i]) + std::abs(taken);
      EXPECT_LE(std::abs(other->values[i] - row->values[i] - taken), 4e-16 * size) << name;
      most = std::max(most, std::abs(taken));
    }
  }
  EXPECT_GT(most, 0.1);
}

TEST_F(Rotors, LeaveNothingWhereTheyAreDeclared) {
  const auto plain = identified("plain", "plain"), with = identified("rotors", "rotors"),
             undeclared = identified("rotors", "plain");
  const auto number = [](const nlohmann::json& result) {
    return result["objective"]["undivided"].get<double>();
  };
  const auto mass = [](const nlohmann::json& result) {
    return result["links"][0]["parameters"][0].get<double>();
  };
  EXPECT_NEAR(mass(with), mass(plain), 1e-9 * mass(plain));
  // Without noise little is left but what the rotors took.
  EXPECT_LT(number(plain), 1e-6 * number(undeclared));
  EXPECT_LT(number(with), 1e-6 * number(undeclared));
}

TEST_F(Rotors, AreInThePredictionThatDiagnoseWrites) {
  ASSERT_EQ(shapeid(fmt::format("simulate --robot {}quadruped.urdf --robot-yaml rotors.yaml "
                                "--seconds 10 --out long.csv.gz",
                                robots))
                .status,
            0);
  const CommandRun run = shapeid(
      fmt::format("diagnose --robot {}quadruped.urdf --robot-yaml rotors.yaml --log long.csv.gz "
                  "--trust --out predicted --json",
                  robots));
  ASSERT_EQ(run.status, 0) << run.err;
  for (const auto& finding : nlohmann::json::parse(run.out)["findings"]) {
    EXPECT_NE(finding["effect"], "rotor_inertia") << "which is declared";
  }
  const std::string header = text_of(scratch() + "/predicted/predict_torque.hpp");
  EXPECT_NE(
      header.find(fmt::format("tau[2] += {} * ddq[2];  // rotor\n", motor_inertia * gear * gear)),
      std::string::npos)
      << header.substr(header.find("inline void predict("));
}

}  // namespace
}  // namespace shapeid::test
