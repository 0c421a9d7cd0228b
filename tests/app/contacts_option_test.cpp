// What is asked of a log about contacts, by --contacts, and what is said where nothing is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "shapeid/app/inputs.hpp"
#include "shapeid/tests/app/changed_log.hpp"
#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/support/files.hpp"

namespace shapeid::test {
namespace {

/// A simulated trot without the columns whose names begin so; its path.
std::string trot_without(const std::string& prefix) {
  simulated_log("trot.csv", "--seconds 3");
  write_changed("trot.csv", "fewer.csv", as_it_is, {prefix});
  return scratch() + "/fewer.csv";
}

app::MotionInputs inputs_for(const std::string& log) {
  app::MotionInputs inputs;
  inputs.robot = robots + "quadruped.urdf";
  inputs.log = log;
  inputs.robot_yaml = scratch_file("no_contacts.yaml", "noise: {tau: 1}\n");
  return inputs;
}

TEST(ContactsOption, WhoDoesNotAskForContactsNeedsNoFlags) {
  app::MotionInputs inputs = inputs_for(trot_without("contact."));
  inputs.robot_yaml = robots + "quadruped.robot.yaml";
  for (const std::string& contacts : {std::string("auto"), std::string("none")}) {
    inputs.contacts = contacts;
    const app::RobotInputs robot = app::read_robot(inputs);
    ASSERT_FALSE(robot.robot.contacts.empty());
    app::LogSamples samples(inputs.log, robot, inputs);
    ASSERT_TRUE(samples.next());
    EXPECT_EQ(samples.report().contacts_derived, contacts == "auto");
  }
}

TEST(ContactsOption, ARobotThatIsTakenToTouchNothingIsSaidTo) {
  app::MotionInputs inputs = inputs_for(trot_without("contact."));
  const auto is_said = [&] {
    const std::vector<std::string> warnings = app::read_robot(inputs).warnings;
    return std::ranges::any_of(warnings, [](const std::string& warning) {
      return warning.find("taken to touch nothing") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_said());
  inputs.contacts = "none";
  EXPECT_FALSE(is_said());
  inputs = inputs_for(scratch() + "/trot.csv");  // whose flags name the feet
  EXPECT_FALSE(is_said());
}

TEST(ContactsOption, ARootFloatsByItsSensorsAlone) {
  const std::string log = trot_without("base.");
  EXPECT_EQ(app::read_robot(inputs_for(log)).robot.root, Root::fixed);
  std::string text = text_of(log);
  text.insert(text.find('\n'), ",base.temperature");
  for (std::size_t at = text.find('\n'); (at = text.find('\n', at + 1)) != std::string::npos;) {
    text.insert(at, ",20");
    at += 3;
  }
  EXPECT_EQ(app::read_robot(inputs_for(scratch_file("warm.csv", text))).robot.root, Root::fixed);
  EXPECT_EQ(app::read_robot(inputs_for(trot_without("base.accel."))).robot.root, Root::floating);
}

}  // namespace
}  // namespace shapeid::test
