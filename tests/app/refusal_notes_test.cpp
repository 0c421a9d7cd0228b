// What was noted of a log stands beside its refusal: it may be why.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

void turn_torques(NamedRow& values) {
  values.each("tau.", [](double& torque) { torque = -torque; });
}

/// Readings of a knee are held where it swings.
void write_held(void (*other)(NamedRow&)) {
  simulated_log("sound.csv", "--seconds 2");
  int row = 0;
  double held = 0.0;
  write_changed("sound.csv", "held.csv", [&](NamedRow& values) {
    constexpr int begin = 739, end = 858;
    double& knee = values["q.FR_knee"];
    if (row == begin) held = knee;
    if (row >= begin && row < end) knee = held;
    ++row;
    other(values);
  });
}

/// Likewise, and every torque has the other sign.
void write_held_and_turned() { write_held(turn_torques); }

void expect_notes_before(const CommandRun& run, const std::string& refusal) {
  const std::string note = "note: ", says = "held.csv:741: q.FR_knee stays the same for 0.24 s";
  expect_one_line(run, 1, refusal);
  const std::size_t at = run.err.find(says);
  ASSERT_NE(at, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find(says, at + 1), std::string::npos) << "once: " << run.err;
  EXPECT_NE(run.err.rfind(note, at), std::string::npos);
  EXPECT_LT(at, run.err.find("shapeid: " + refusal)) << "the reason is the last line: " << run.err;
}

TEST(RefusalNotes, StandBeforeTheReasonWhateverTheVerb) {
  write_held_and_turned();
  const std::string given = quadruped_files + " --log held.csv ";
  expect_notes_before(shapeid("identify --divisions 0 " + given), "refused (no-mass): ");
  expect_notes_before(shapeid("diagnose " + given), "refused (torque-sign): ");
  simulated_log("another.csv", "--seconds 2 --seed 2");
  write_changed("another.csv", "other.csv", turn_torques);
  expect_notes_before(shapeid("batch --divisions 0 " + given + "other.csv"), "refused (no-mass): ");
  expect_notes_before(shapeid("identify --online --window 100000 " + given),
                      "refused (too-short): ");
}

/// What the loop itself finds too little of.
TEST(RefusalNotes, StandBeforeTheReasonOfTheLoop) {
  write_held([](NamedRow&) {});
  simulated_log("another.csv", "--seconds 2 --seed 2");
  expect_notes_before(shapeid("diagnose " + quadruped_files + " --log held.csv --test another.csv"),
                      "refused (too-short): the log gives ");
}

/// Of a log that is refused by itself, too: what was read of it before is noted.
TEST(RefusalNotes, OfOneOfManyLogs) {
  write_held_and_turned();
  simulated_log("another.csv", "--seconds 2 --seed 2");
  write_changed("held.csv", "unknown.csv", [](NamedRow& values) {
    values.each("contact.", [](double& flag) { flag = -1.0; });
  });
  const CommandRun run =
      shapeid(fmt::format("batch --divisions 0 {} --log another.csv unknown.csv", quadruped_files));
  expect_one_line(run, 1, "refused (no-data): 1 of 2 logs are refused: unknown.csv: ");
  EXPECT_NE(run.err.find("note: unknown.csv: unknown.csv:741: q.FR_knee stays the same"),
            std::string::npos)
      << run.err;
}

/// Bad input is one line: what is wrong with it was found without asking what it could mean.
TEST(RefusalNotes, NoneBesideBadInput) {
  write_held_and_turned();
  expect_one_line(shapeid(fmt::format("identify {} --log held.csv --cutoff 300", quadruped_files)),
                  2, "--cutoff 300: a filter of 300 Hz");
}

}  // namespace
}  // namespace shapeid::test
