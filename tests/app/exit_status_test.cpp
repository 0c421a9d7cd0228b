// How a call ends, whatever its verb did: status, and one line of complaint.
#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>

#include "shapeid/app/run_command.hpp"
#include "shapeid/models/contract.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

struct Ended {
  int status;
  std::string said;
};

/// `program work ARGUMENT`, where the verb does this.
Ended call(const std::function<void()>& work, const char* argument = nullptr) {
  CLI::App program("a program", "program");
  program.add_subcommand("work", "its verb")->callback(work);
  program.require_subcommand(1);
  std::array<std::string, 3> words = {"program", "work", argument == nullptr ? "" : argument};
  std::array<char*, 3> argv = {words[0].data(), words[1].data(), words[2].data()};
  testing::internal::CaptureStderr();
  const int status = run_command(program, argument == nullptr ? 2 : 3, argv.data());
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  return {status, testing::internal::GetCapturedStderr()};
}

TEST(ExitStatus, IsZeroAndSilentWhereAllWentWell) {
  bool worked = false;
  const Ended ended = call([&] { worked = true; });
  EXPECT_TRUE(worked);
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.said, "");
}

TEST(ExitStatus, IsOneForDataThatCannotAnswer) {
  const Ended ended = call([] { throw Refusal("too-short", "there are two samples"); });
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "shapeid: refused (too-short): there are two samples\n");
}

TEST(ExitStatus, IsTwoForInputThatIsWrong) {
  const Ended ended = call([] { throw InputError({"a.csv", 3}, "is blank", "remove it"); });
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.said, "shapeid: a.csv:3: is blank; remove it\n");
  const Ended option = call([] {}, "--unheard-of");
  EXPECT_EQ(option.status, 2);
  EXPECT_NE(option.said.find("--unheard-of"), std::string::npos) << option.said;
}

TEST(ExitStatus, IsThreeForADefectOfOurs) {
  const auto expect_defect = [](const std::function<void()>& work, const std::string& reason) {
    const Ended ended = call(work);
    EXPECT_EQ(ended.status, 3);
    EXPECT_EQ(ended.said,
              "shapeid: this is a defect of shapeid, please report it: " + reason + "\n");
  };
  expect_defect([] { demand("the sum is odd", "sum.cpp", 7); },
                "sum.cpp:7: contract broken: the sum is odd");
  expect_defect([] { throw std::out_of_range("an index"); }, "an index");
}

}  // namespace
}  // namespace shapeid::app
