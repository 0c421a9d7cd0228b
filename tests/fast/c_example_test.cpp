// docs/examples/identifier.c as a program: a trot through it, and bad input.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid {
namespace {

struct ProgramRun {
  int status = -1;
  std::string out, err;
};

ProgramRun run_example(const std::string& arguments, const std::string& samples) {
  const test::ScratchFolder folder;
  const std::string in = folder.write("samples", samples);
  const std::string out = folder.path("out"), err = folder.path("err");
  const std::string line =
      fmt::format("'{}' {} <'{}' >'{}' 2>'{}'", SHAPEID_EXAMPLE, arguments, in, out, err);
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::text_of(out), test::text_of(err)};
}

std::string quadruped() {
  return fmt::format("'{}' '{}' '{}'", test::bundled_file("urdf"), test::bundled_file("robot.yaml"),
                     test::bundled_file("shapes.yaml"));
}

std::string line_of(const Sample& s) {
  std::string line = fmt::format("{:.17g}", s.time);
  const auto add = [&line](const auto& numbers) {
    for (const double number : numbers) line += fmt::format(" {:.17g}", number);
  };
  add(s.base_angular_velocity);
  add(s.base_angular_acceleration);
  add(s.base_specific_force);
  add(s.q);
  add(s.dq);
  add(s.ddq);
  add(s.tau);
  for (const bool touches : s.in_contact) line += touches ? " 1" : " 0";
  return line + "\n";
}

std::vector<Sample> samples(std::size_t count) {
  const Robot robot = test::bundled_quadruped();
  return test::trot(robot, stacked_parameters(robot), 5, count, test::Noise::sensors);
}

/// As the example prints it; with 17 digits, which is all of a double.
std::string line_of(const fast::Identifier& identifier, const std::string& stopped_by) {
  const fast::WindowAnswer& answer = identifier.answer();
  std::string line = fmt::format("{:.17g} {:.17g} {:.17g} {} {}", answer.time, answer.value.total(),
                                 answer.gap, answer.divisions, stopped_by);
  for (const double parameter : identifier.filtered()) line += fmt::format(" {:.17g}", parameter);
  return line + "\n";
}

class CExampleDivides : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(CExample, CExampleDivides, testing::Values(0, 3));

// Numbers pass as text with all digits, and the code is the same.
TEST_P(CExampleDivides, PrintsWhatTheIdentifierAnswers) {
  const Robot robot = test::bundled_quadruped();
  fast::IdentifierSettings settings;
  settings.expected_mass = 6.0;  // the middle of the range in quadruped.robot.yaml
  settings.division.most_divisions = GetParam();
  fast::Identifier identifier(robot, test::bundled_shapes(robot), settings);
  std::string input, expected;
  for (const Sample& s : samples(200)) {
    input += line_of(s);
    if (identifier.feed(s) != fast::Identifier::Fed::answered) continue;
    ASSERT_EQ(identifier.answer().stopped_by, fast::Division::Stop::limit);
    expected += line_of(identifier, "limit");
  }
  ASSERT_NE(expected, "");

  const std::string arguments = GetParam() == 0 ? "" : fmt::format(" {}", GetParam());
  const ProgramRun run = run_example(quadruped() + arguments, input);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, expected);
}

TEST(CExample, LinesMayEndAsElsewhere) {
  std::string unix_lines, dos_lines;
  for (const Sample& s : samples(20)) {
    unix_lines += line_of(s);
    dos_lines += line_of(s);
    dos_lines.insert(dos_lines.size() - 1, " \r");
  }
  unix_lines.pop_back();
  EXPECT_EQ(run_example(quadruped(), unix_lines).out, run_example(quadruped(), dos_lines).out);
}

void expect_refused(const ProgramRun& run, const std::string& message) {
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "one line: " << run.err;
}

TEST(CExample, RefusesBadFiles) {
  const test::ScratchFolder folder;
  const std::string bad = folder.write("bad.urdf", "<robot name='r'><link name='a'>");
  expect_refused(run_example("nowhere.urdf a b", ""), "nowhere.urdf");
  expect_refused(run_example(fmt::format("'{}' a b", bad), ""), "bad.urdf:");
  expect_refused(run_example(fmt::format("'{}' nowhere.yaml b", test::bundled_file("urdf")), ""),
                 "nowhere.yaml");
  expect_refused(run_example("", ""), "usage");
  for (const char* wrong : {"-1", "3x", "x", "''", "99999999999", "1 1"}) {
    expect_refused(run_example(quadruped() + ' ' + wrong, ""), "usage");
  }
}

TEST(CExample, RefusesBadLines) {
  const std::vector<Sample> good = samples(2);
  const std::string first = line_of(good[0]), second = line_of(good[1]);
  const std::string shorter = second.substr(0, second.size() - 3) + "\n";
  for (const std::string& wrong :
       {std::string("\n"), shorter, "one " + second, "1 " + second, second.substr(0, 40)}) {
    const std::string samples = first + wrong;
    expect_refused(run_example(quadruped(), samples), "samples:2: ");
    expect_refused(run_example(quadruped(), samples + first), "samples:2: ");
  }
}

// What is no number would touch, unequal to zero as it is.
TEST(CExample, RefusesContactsThatAreNeitherOneNorZero) {
  const std::string good = line_of(samples(1)[0]);
  for (const std::string wrong : {"nan", "2", "-1", "0.5"}) {
    expect_refused(run_example(quadruped(), good + good.substr(0, good.size() - 2) + wrong + "\n"),
                   "samples:2: a contact");
  }
}

TEST(CExample, TooFewSamplesAreNoAnswer) {
  const ProgramRun run = run_example(quadruped(), line_of(samples(1)[0]));
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace shapeid
