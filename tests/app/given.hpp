// What is given to a verb and cannot be meant; each was once taken (or crashed, or never ended).
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {

class Given : public testing::Test {
 protected:
  static void SetUpTestSuite() { simulated_log("given.csv", "--seconds 2"); }

  /// One line that says so, exit status 2 (or another), nothing printed.
  static void expect_refused(const std::string& arguments, const std::string& says,
                             int status = 2) {
    SCOPED_TRACE("shapeid " + arguments);
    const CommandRun run = shapeid(arguments);
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_NE(run.err.find(says), std::string::npos) << run.err;
    EXPECT_EQ(lines_said(run), 1) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
};

}  // namespace shapeid::test
