// A program that embeds us may have set a locale in which 1.5 is written 1,5: nothing that is read
// or written may change.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <locale>
#include <string>

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/robot/two_link_robot.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

/// Decimal commas, and points between groups of three digits.
class Commas : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// C++'s global locale.
class ForeignLocale {
 public:
  ForeignLocale() : before_(std::locale::global(std::locale(std::locale(), new Commas))) {}
  ~ForeignLocale() { std::locale::global(before_); }
  ForeignLocale(const ForeignLocale&) = delete;
  ForeignLocale& operator=(const ForeignLocale&) = delete;

 private:
  std::locale before_;
};

/// C's locale: one that is installed, or compiled from the sources of the package `locales`.
class ForeignCLocale {
 public:
  ForeignCLocale() {
    for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "es_ES.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) return;
    }
    const std::string compiled = folder_.path("de_DE.UTF-8");
    const std::string command = "localedef -i de_DE -f UTF-8 '" + compiled + "' >/dev/null 2>&1";
    if (std::system(command.c_str()) != 0) return;
    ::setenv("LOCPATH", folder_.path("").c_str(), 1);
    std::setlocale(LC_ALL, "de_DE.UTF-8");
    ::unsetenv("LOCPATH");
  }
  ~ForeignCLocale() { std::setlocale(LC_ALL, "C"); }
  ForeignCLocale(const ForeignCLocale&) = delete;
  ForeignCLocale& operator=(const ForeignCLocale&) = delete;

  /// Whether 1.5 is written 1,5 now.
  [[nodiscard]] static bool is_set() { return *std::localeconv()->decimal_point == ','; }

 private:
  test::ScratchFolder folder_;
};

/// Everything that a session reads and writes, as one text with every bit of every number.
std::string session() {
  const test::ScratchFolder folder;
  const std::string urdf = folder.write(
      "r.urdf",
      "<robot name=\"r\"><link name=\"a\"><inertial><origin xyz=\"0.1 -2.5e-3 1234.5\"/><mass "
      "value=\"1.25\"/><inertia ixx=\"0.5\" ixy=\"0\" ixz=\"0\" iyy=\"0.5\" iyz=\"0\" izz=\"0.5\"/>"
      "</inertial></link></robot>");
  const Robot robot = read_urdf(urdf).robot;
  std::string all = write_urdf(urdf, robot, {{0, robot.links[0].inertia}});

  Robot hopper = test::two_link_robot();
  const RobotNotes notes = read_robot_yaml(
      folder.write("r.yaml", "imu: {xyz: [0.125, 12.345, -1e-3]}\nnoise: {tau: 0.5}\n"), hopper);
  const BodyModel model = read_shapes_yaml(
      folder.write("s.yaml", "trunk:\n  - {kind: ellipsoid, size: [0.5, 1.5, 2.25]}\n"), hopper);
  const Mapping mapping = read_mapping_yaml(
      folder.write("m.yaml", "columns: {time: {from: t, scale: 0.001, offset: 1234.5}}\n"));

  const std::string log = folder.path("l.csv");
  LogWriter writer(log, {"time", "x"});
  writer.write({0.125, 1234567.5});
  writer.write({1e-300, -0.1});
  writer.close();
  all += test::text_of(log);
  LogReader reader(log);

  MassProblem p;
  p.Y = Eigen::MatrixXd::Constant(1, 10, 0.1);
  p.U = shape_columns(model);
  p.V = shape_volumes(model);
  p.F = p.W = Eigen::VectorXd::Constant(1, 1234.5);
  p.F[0] += notes.imu.translation().sum() + mapping.columns.at("time").scale +
            mapping.columns.at("time").offset + reader.next()->values[1] + reader.next()->values[1];
  const std::string json = problem_to_json(p);
  return all + json + problem_to_json(stated_problem_from_json(json, "p.json"));
}

TEST(HostileLocale, OfCppChangesNothing) {
  const std::string before = session();
  const ForeignLocale foreign;
  EXPECT_EQ(session(), before);
}

TEST(HostileLocale, OfCChangesNothing) {
  const std::string before = session();
  const ForeignCLocale foreign;
  if (!ForeignCLocale::is_set()) {
    GTEST_SKIP() << "no locale with decimal commas, and no sources to compile one (apt: locales)";
  }
  EXPECT_EQ(session(), before);
}

}  // namespace
}  // namespace shapeid
