// Logs that are endless, packed, linked, or change while they are read.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "shapeid/models/log.hpp"
#include "shapeid/tests/hostile/refused.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::refusal, test::repeated, test::says;

std::size_t rows_of(const std::string& path) {
  LogReader log(path);
  std::size_t rows = 0;
  while (log.next()) ++rows;
  return rows;
}

std::string refusal_of(const std::string& path) {
  return refusal([&] { static_cast<void>(rows_of(path)); });
}

/// Writes `text` so many times, packed.
void write_packed(const std::string& path, const std::string& header, const std::string& text,
                  int times) {
  gzFile file = gzopen(path.c_str(), "wb1");
  ASSERT_NE(file, nullptr);
  gzwrite(file, header.data(), static_cast<unsigned>(header.size()));
  for (int i = 0; i < times; ++i) gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
}

// 1 MB on disk, 160 MB of rows: what a log of any length takes, as it is read row by row.
TEST(HostileLog, PackedRowsTakeNoMemory) {
  const test::ScratchFolder folder;
  const std::string path = folder.path("a.csv.gz");
  write_packed(path, "a,b\n", repeated("0.125,1\n", 1 << 17), 160);
  constexpr std::size_t rows = std::size_t{160} << 17U;
#ifdef __SANITIZE_ADDRESS__  // which keeps freed memory
  EXPECT_EQ(rows_of(path), rows);
#else
  const auto peak_kilobytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  constexpr long few_blocks = 4096;  // kB
  const long before = peak_kilobytes();
  EXPECT_EQ(rows_of(path), rows);
  EXPECT_LT(peak_kilobytes() - before, few_blocks);
#endif
}

// One archive behind the other is one log. What is no archive there is damage, where zlib's own
// reader sees the end.
TEST(HostileLog, WhatStandsBehindAnArchive) {
  const test::ScratchFolder folder;
  const auto packed = [&](const std::string& header, int rows) {
    const std::string path = folder.path("part.csv.gz");
    write_packed(path, header, "0.125,1\n", rows);
    return test::text_of(path);
  };
  const std::string first = packed("a,b\n", 300), second = packed("", 7000);
  const auto written = [&](const std::string& bytes) { return folder.write("a.csv.gz", bytes); };
  EXPECT_EQ(rows_of(written(first + second)), 7300U);
  for (const std::size_t at : {0U, 1U, 2U}) {
    std::string flipped = second;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    EXPECT_TRUE(says(refusal_of(written(first + flipped)), "cannot be read: ")) << at;
  }
  for (const std::size_t size : {std::size_t{1}, std::size_t{12}, second.size() - 1}) {
    EXPECT_TRUE(says(refusal_of(written(first + second.substr(0, size))),
                     "cannot be read: unexpected end of file"))
        << size;
  }
  EXPECT_TRUE(says(refusal_of(written(first + "1,2\n")), "cannot be read: "));
}

// Ten gigabytes of zeros, as a sparse file and packed a thousandfold: one line that never ends.
TEST(HostileLog, ALineWithoutEnd) {
  const test::ScratchFolder folder;
  const std::string sparse = folder.write("sparse.csv", "a,b\n1,2\n");
  std::filesystem::resize_file(sparse, std::uintmax_t{10} << 30U);
  EXPECT_TRUE(says(refusal_of(sparse), "sparse.csv:3: line longer than 1048576 bytes"));
  const std::string packed = folder.path("packed.csv.gz");
  write_packed(packed, "a,b\n1,2\n", std::string(1 << 20, '0'), 256);
  EXPECT_TRUE(says(refusal_of(packed), "packed.csv.gz:3: line longer than 1048576 bytes"));
}

TEST(HostileLog, AHundredThousandColumns) {
  const test::ScratchFolder folder;
  std::string header = "c0", row = "0";
  for (int i = 1; i < 100000; ++i) {
    header += fmt::format(",c{}", i);
    row += ",1";
  }
  EXPECT_EQ(rows_of(folder.write("wide.csv", header + "\n" + row + "\n" + row + "\n")), 2U);
}

TEST(HostileLog, LinksPipesAndFolders) {
  const test::ScratchFolder folder;
  const std::string file = folder.write("a.csv", "a,b\n1,2\n");
  std::filesystem::create_symlink(file, folder.path("link.csv"));
  EXPECT_EQ(rows_of(folder.path("link.csv")), 1U);
  std::filesystem::create_symlink(folder.path("loop.csv"), folder.path("loop.csv"));
  EXPECT_TRUE(says(refusal_of(folder.path("loop.csv")), "cannot be opened"));
  EXPECT_TRUE(
      says(refusal_of(std::filesystem::path(file).parent_path().string()), "cannot be read"));

  const std::string pipe = folder.path("pipe.csv");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "a,b\n1,2\n3,4\n"; });
  EXPECT_EQ(rows_of(pipe), 2U);
  writer.join();
}

// The rest of a file goes away, or other text takes its place, between two rows.
TEST(HostileLog, FilesThatChangeMeanwhile) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("a.csv", "a,b\n" + repeated("1,2\n", 100000));
  {
    LogReader log(path);
    ASSERT_TRUE(log.next());
    std::filesystem::resize_file(path, 0);
    std::size_t rows = 1;
    const std::string message = refusal([&] {
      while (log.next()) ++rows;
    });
    EXPECT_LT(rows, 100000U);  // of the first block, in which a row may be cut
    EXPECT_TRUE(message == "accepted" || says(message, "a.csv:")) << message;
  }
  const std::string other = folder.write("b.csv", "a,b\n" + repeated("1,2\n", 100000));
  LogReader log(other);
  ASSERT_TRUE(log.next());
  std::ofstream(other, std::ios::in | std::ios::binary) << std::string(400000, 'x');
  EXPECT_TRUE(says(refusal([&] {
                     while (log.next()) continue;
                   }),
                   "b.csv:"));
}

}  // namespace
}  // namespace shapeid
