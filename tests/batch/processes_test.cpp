// Several processes say to the last byte what one says.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/batch/pieces.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

CommandRun processes(int count, const std::string& options) {
  return program(fmt::format("mpirun --allow-run-as-root --oversubscribe -n {} {}/shapeid_mpi {}",
                             count, SHAPEID_BUILD_DIR, options));
}

TEST(BatchProcesses, SameBytesAsOneProcess) {
  // Two blocks of seven logs: most merges happen away from the process that solves.
  for (const char* blocks : {"--blocks 2", ""}) {
    const std::string options =
        fmt::format("{} --json --divisions 5 {} --log {}", bundled_robot(), blocks, piece_names());
    const CommandRun one = shapeid("batch " + options);
    ASSERT_EQ(one.status, 0) << one.err;
    for (const int count : {1, 2, 3}) {
      const CommandRun many = processes(count, options);
      ASSERT_EQ(many.status, 0) << many.err;
      EXPECT_TRUE(many.out == one.out) << count << " processes say something else";
    }
  }
}

TEST(BatchProcesses, ABadLogEndsAllOfThem) {
  const std::string options =
      fmt::format("{} --json --divisions 0 --log {} absent.csv", bundled_robot(), piece_names());
  const CommandRun refused = processes(2, options);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("1 of 8 logs are refused: absent.csv: "), std::string::npos)
      << refused.err;
  const CommandRun skipped = processes(2, options + " --skip-refused");
  const CommandRun one = shapeid("batch " + options + " --skip-refused");
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_TRUE(skipped.out == one.out);
  EXPECT_EQ(processes(3, "--robot absent.urdf --log piece0.csv").status, 2);
}

}  // namespace
}  // namespace shapeid::test
