// Logs that cannot be meant: readings, units, names; and logs that are right and look odd.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/models/log.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/app/given.hpp"

namespace shapeid::test {
namespace {

/// The log with one number changed.
void write_with(const std::string& column, int line, double value) {
  int at = 1;  // the header
  write_changed("given.csv", "changed.csv", [&](NamedRow& row) {
    if (++at == line) row[column] = value;
  });
}

/// A log with joints alone, of a robot with an IMU.
TEST_F(Given, ALogWithoutItsBase) {
  LogReader log(scratch() + "/given.csv");
  std::vector<std::size_t> kept;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < log.columns().size(); ++c) {
    if (log.columns()[c].starts_with("base.")) continue;
    kept.push_back(c);
    names.push_back(log.columns()[c]);
  }
  LogWriter out(scratch() + "/joints.csv", names);
  while (const std::optional<LogRow> row = log.next()) {
    std::vector<double> values;
    for (const std::size_t c : kept) values.push_back(row->values[c]);
    out.write(values);
  }
  out.close();
  scratch_file("feet.yaml", "contacts: [{link: FR_foot}]\n");
  expect_refused(
      fmt::format("identify --robot {}quadruped.urdf --robot-yaml feet.yaml --log joints.csv",
                  robots),
      "the log has no base.* columns, though feet.yaml has contacts");
  scratch_file("imu.yaml", "imu: {xyz: [0, 0, 0.1], rpy: [0, 0, 1.57]}\n");
  const std::string robot = fmt::format("--robot {}quadruped.urdf --robot-yaml imu.yaml ", robots);
  expect_refused(fmt::format("identify {} --log joints.csv", robot),
                 "the log has no base.* columns, though imu.yaml has an IMU");
  const CommandRun run = shapeid(fmt::format("inspect joints.csv {}", robot));
  EXPECT_NE(run.out.find("the base is taken as fixed"), std::string::npos) << run.out << run.err;
}

/// A log that ends within the stretch that is held out: its samples are good, but none is fitted.
TEST_F(Given, LogsOfWhichNothingIsFitted) {
  for (const char* verb : {"identify", "diagnose --trust"}) {
    expect_refused(fmt::format("{} {} --log given.csv --hold-out 1", verb, quadruped_files),
                   "held out for the test, or too near to what is; give --test", 1);
  }
}

/// It is the option that is wrong, whatever the log.
TEST_F(Given, AFilterThatTheRateDoesNotAllowIsRefusedByTheOptionsName) {
  const std::string files = quadruped_files + " --log given.csv --out high";
  for (const char* verb : {"identify", "diagnose", "batch", "load --area base 0 0.1 0 0.1 0 0.1"}) {
    expect_refused(fmt::format("{} {} --cutoff 250", verb, files),
                   "--cutoff 250: a filter of 250 Hz for data at 500 Hz; choose a cutoff between 0 "
                   "and 250 Hz, half the rate");
  }
  for (const char* verb : {"identify", "batch", "load --area base 0 0.1 0 0.1 0 0.1"}) {
    expect_refused(fmt::format("{} {} --row-cutoff 300", verb, files),
                   "--row-cutoff 300: a filter of 300 Hz for data at 500 Hz");
  }
  for (const char* verb : {"track", "inspect"}) {
    expect_refused(fmt::format("{} {} given.csv --cutoff 1e6", verb, quadruped_files),
                   "--cutoff 1e+06: a filter of 1e+06 Hz for data at 500 Hz");
  }
}

/// A log that is slower than the usual filter is looked at with another.
TEST_F(Given, SlowLogsCanBeInspected) {
  LogReader log(scratch() + "/given.csv");
  LogWriter out(scratch() + "/slow.csv", log.columns());
  constexpr int every = 20;  // of 500 Hz
  for (int i = 0; std::optional<LogRow> row = log.next(); ++i) {
    if (i % every == 0) out.write(row->values);
  }
  out.close();
  const std::string inspect = fmt::format("inspect slow.csv {} ", quadruped_files);
  expect_refused(inspect, "choose a cutoff");
  const CommandRun seen = shapeid(inspect + "--cutoff 5");
  EXPECT_EQ(seen.status, 0) << seen.err;
  expect_refused("inspect slow.csv --cutoff 5", "--cutoff requires --robot");
}

TEST_F(Given, ColumnsWithoutANumberAreSaidToHaveNone) {
  scratch_file("empty.csv", "time,a,b\n0,,1\n1,,2\n");
  const CommandRun seen = shapeid("inspect empty.csv");
  EXPECT_EQ(seen.status, 0) << seen.err;
  EXPECT_EQ(seen.out.find("inf"), std::string::npos) << seen.out;
  EXPECT_NE(seen.out.find("no number        2\n"), std::string::npos) << seen.out;
}

TEST_F(Given, ReadingsThatNoRobotHas) {
  const auto identified =
      fmt::format("identify {} --log changed.csv --divisions 0", quadruped_files);
  const std::vector<std::pair<std::string, double>> readings = {{"base.gyro.x", 1e80},
                                                                {"base.gyro.z", -2e3},
                                                                {"base.accel.y", 1e6},
                                                                {"tau.FR_knee", 1e10},
                                                                {"dq.RL_hip", -1e6}};
  for (const auto& [column, value] : readings) {
    write_with(column, 502, value);
    expect_refused(identified, fmt::format("changed.csv:502, column {}", column));
  }
  for (const double time : {1.7e18, 1e30, 2e5}) {
    write_with("time", 1001, time);
    expect_refused(identified, "changed.csv:1001, column time");
    expect_refused(fmt::format("inspect changed.csv {}", quadruped_files),
                   "changed.csv:1001, column time");
  }
  write_with("time", 2, -1.7e18);
  expect_refused(fmt::format("track {} changed.csv", quadruped_files),
                 "changed.csv:2, column time");
}

TEST_F(Given, LogsThatAskForNoMass) {
  const auto scaled_by = [](const std::string& prefix, double factor) {
    return [=](NamedRow& row) { row.each(prefix, [=](double& value) { value *= factor; }); };
  };
  const auto identified =
      fmt::format("identify {} --log changed.csv --divisions 0", quadruped_files);
  write_changed("given.csv", "changed.csv", scaled_by("base.accel.", -1.0));
  expect_refused(identified, "asks for no mass", 1);
  write_changed("given.csv", "changed.csv", scaled_by("tau.", -1.0));
  expect_refused(identified, "asks for no mass", 1);
  simulated_log("other.csv", "--seconds 2 --seed 2");
  write_changed("other.csv", "likewise.csv", scaled_by("tau.", -1.0));
  expect_refused(
      fmt::format("batch {} --log changed.csv likewise.csv --divisions 0", quadruped_files),
      "asks for no mass", 1);
  write_changed("given.csv", "changed.csv", scaled_by("tau.", 0.0));
  expect_refused(identified, "never changes while the joints move");
}

/// Units are judged in logs with exact derivatives, too.
TEST_F(Given, ExactLogsInOtherUnits) {
  simulated_log("exact.csv", "--seconds 2 --exact");
  write_changed("exact.csv", "changed.csv", [](NamedRow& row) {
    row.each("base.accel.", [](double& value) { value /= 9.81; });
  });
  expect_refused(fmt::format("identify {} --log changed.csv --exact", quadruped_files),
                 "looks like g");
}

/// Drives that are off for the first second: no window of zeros may spoil what follows.
TEST_F(Given, TrackingBeginsWithDrivesThatAreOff) {
  const std::string arm =
      "<robot name='arm'><link name='world'/><link name='bar'><inertial><origin xyz='0.1 0.02 "
      "-0.3'/>"
      "<mass value='1.5'/><inertia ixx='0.05' ixy='0.001' ixz='0.002' iyy='0.06' iyz='-0.003' "
      "izz='0.02'/></inertial><collision><origin xyz='0.1 0 -0.3'/><geometry><box "
      "size='0.2 0.1 0.5'/></geometry></collision></link><joint name='hinge' type='revolute'>"
      "<parent link='world'/><child link='bar'/><axis xyz='0 1 0'/><limit lower='-3' upper='3' "
      "effort='50' velocity='20'/></joint></robot>";
  scratch_file("off.urdf", arm);
  std::string log = "time,q.hinge,tau.hinge\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.002 * i, q = std::sin(3.0 * t), ddq = -9.0 * q;
    const double gravity = 9.81 * 1.5 * (0.1 * std::cos(q) - 0.3 * std::sin(q));
    const double tau = i < 600 ? 0.0 : 0.21 * ddq - gravity + 0.001 * std::sin(977.0 * t);
    log += fmt::format("{},{},{}\n", t, q, tau);
  }
  scratch_file("off.csv", log);
  const CommandRun run = shapeid("track --robot off.urdf off.csv --whole-body");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("[0.0,null]"), std::string::npos);
  EXPECT_EQ(run.out.find("NaN"), std::string::npos);
  EXPECT_NE(run.out.find("\"answered\":true"), std::string::npos);
}

/// A name is any bytes; JSON is not.
TEST_F(Given, LogsWithNamesThatAreNoText) {
  const std::string name = "given\xfe.csv";
  scratch_file(name, read_small_file(simulated_log("other.csv", "--seconds 2 --seed 2"), 1 << 26));
  EXPECT_EQ(shapeid("inspect --json '" + name + "'").status, 0);
  EXPECT_EQ(
      shapeid(fmt::format("identify {} --log '{}' --divisions 0 --json", quadruped_files, name))
          .status,
      0);
  const CommandRun batch =
      shapeid(fmt::format("batch {} --log given.csv '{}' '{}' --skip-refused --divisions 0 --json",
                          quadruped_files, name, "none\xfe.csv"));
  EXPECT_EQ(batch.status, 0) << batch.err;
  EXPECT_EQ(shapeid("simulate --seconds 0.2 --json --out 'new\xfe.csv'").status, 0);
}

}  // namespace
}  // namespace shapeid::test
