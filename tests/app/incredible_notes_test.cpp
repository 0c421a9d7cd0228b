// What would explain a log, but only by more of it than there can be.
#include <gtest/gtest.h>

#include <cstddef>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>

#include "shapeid/tests/app/arms.hpp"
#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {
namespace {

/// What diagnose notes of the arms with torques that are so many rows late.
std::string notes_with_torques_late_by(std::size_t rows) {
  scratch_file("late.urdf", arms_urdf(masses_of_arms()));
  write_arms_log("late", masses_of_arms(), {0.02, 0.02});
  std::deque<double> waiting;  // of all joints, row by row
  const std::size_t ahead = rows * (links_of_arms - 1);
  write_changed("late.csv", "late.later.csv", [&](NamedRow& row) {
    row.each("tau.", [&](double& tau) {
      waiting.push_back(tau);
      tau = waiting.front();
      if (waiting.size() > ahead) waiting.pop_front();
    });
  });
  return diagnosed("--robot late.urdf --log late.later.csv --trust --cutoff 10")["notes"].dump();
}

TEST(IncredibleValues, AreNotedWhereTheyWouldGainMuch) {
  const std::string noted = "but by a value beyond what is believed of it";
  EXPECT_EQ(notes_with_torques_late_by(1).find(noted), std::string::npos);
  const std::string late = notes_with_torques_late_by(8);
  EXPECT_NE(late.find("torque_delay@all would take away"), std::string::npos) << late;
  EXPECT_NE(late.find(noted), std::string::npos) << late;
}

}  // namespace
}  // namespace shapeid::test
