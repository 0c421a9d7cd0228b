#include "shapeid/models/log.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "shapeid/models/contract.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/log_table.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/tests/motion/message_of.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::message_of;
using test::ScratchFolder;
using namespace std::string_literals;

std::vector<LogRow> read_all(const std::string& path) {
  LogReader log(path);
  std::vector<LogRow> rows;
  while (std::optional<LogRow> row = log.next()) rows.push_back(std::move(*row));
  return rows;
}

std::string complaint(const std::string& path) {
  return message_of<InputError>([&] { read_all(path); }, path);
}

TEST(LogReader, ReadsMarksLineEndsQuotesAndMissingValues) {
  const ScratchFolder scratch;
  const auto path = scratch.write(
      "a.csv", "\xEF\xBB\xBF\"time\", q.a ,\"tau,a\"\r\n0,1e-3,+2.5\r\n0.5,,-0\r\n\r\n");
  const LogReader log(path);
  EXPECT_EQ(log.columns(), (std::vector<std::string>{"time", "q.a", "tau,a"}));
  const auto rows = read_all(path);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].line, 2);
  EXPECT_EQ(rows[0].values, (std::vector<double>{0.0, 1e-3, 2.5}));
  EXPECT_EQ(rows[1].line, 3);
  EXPECT_TRUE(std::isnan(rows[1].values[1]));
  EXPECT_TRUE(std::signbit(rows[1].values[2]));
}

TEST(LogReader, LastLineNeedsNoEnd) {
  const ScratchFolder scratch;
  EXPECT_EQ(read_all(scratch.write("a.csv", "a,b\n1,2\n3,4")).size(), 2u);
}

TEST(LogReader, SaysWhatIsWrongWithBrokenFiles) {
  struct Broken {
    std::string text, message;
  };
  const std::string right = "write decimals with a point, and nothing for a missing value";
  const Broken table[] = {
      {"", "x.csv: is empty; begin with a row of column names"},
      {"\n\n", "x.csv: is empty; begin with a row of column names"},
      {"1,2\n3,4\n", "x.csv:1: the first row holds numbers; begin with a row of column names"},
      {"a;b\n0,5;1,5\n", "x.csv:1: fields are not separated by commas; separate fields by commas"},
      {"a,b,a\n1,2,3\n", "x.csv:1, column a: appears twice; give every column its own name"},
      {"a,,c\n1,2,3\n", "x.csv:1, column 2: has no name; name every column"},
      {"a,b\n1,2\n3\n",
       "x.csv:3: has 1 fields where the header has 2; give one number a column, decimals with a "
       "point"},
      {"a,b\n1,5,2\n",
       "x.csv:2: has 3 fields where the header has 2; give one number a column, decimals with a "
       "point"},
      {"# of today\na,b\n1,2\n",
       "x.csv:2: has 2 fields where the header has 1; begin with a row of column names, not with a "
       "comment"},
      {"a,b\n1,\"2,5\"\n",
       "x.csv:2, column b: is not a number (\"2,5\": decimals take a point, not a comma); " +
           right},
      {"a,b\n1,nan\n", "x.csv:2, column b: is not a finite number (\"nan\"); " + right},
      {"a,b\ninf,1\n", "x.csv:2, column a: is not a finite number (\"inf\"); " + right},
      {"a,b\n-Infinity,1\n", "x.csv:2, column a: is not a finite number (\"-Infinity\"); " + right},
      {"a,b\n1abc,1\n", "x.csv:2, column a: is not a number (\"1abc\"); " + right},
      {"a,b\n+-1,1\n", "x.csv:2, column a: is not a number (\"+-1\"); " + right},
      {"a,b\n1,\" \"\n", "x.csv:2, column b: is empty; " + right},
      {"a,b\n1,1e999\n", "x.csv:2, column b: does not fit into a double (\"1e999\"); " + right},
      {"a,b\n1,-1e101\n",
       "x.csv:2, column b: \"-1e101\" is more than any sensor reads; check the value and its unit"},
      {"a,b\n1,2\n\n3,4\n", "x.csv:3: is blank; remove it"},
      {"a,b\n1,\"2\n3,4\n", "x.csv:2: quotes do not match; close every quote on its own line"},
      {"a,b\n1,2\0\n"s, "x.csv:2: holds a NUL byte; a log is text"},
      {"a,b\r1,2\r", "x.csv:1: holds a carriage return inside a line; end lines with LF or CRLF"},
      {std::string(1 << 21, 'a'),
       "x.csv:1: line longer than 1048576 bytes; a log has one row a line"},
  };
  const ScratchFolder scratch;
  for (const Broken& broken : table) {
    EXPECT_EQ(complaint(scratch.write("x.csv", broken.text)), broken.message);
  }
  EXPECT_EQ(complaint(scratch.path("none.csv")),
            "none.csv: cannot be opened; give a readable CSV file");
}

TEST(LogReader, TruncatedOrDamagedArchivesAreRefused) {
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv.gz");
  LogWriter writer(path, {"a", "b"});
  for (int i = 0; i < 20000; ++i) writer.write({i * 0.1, std::sin(i)});
  writer.close();
  EXPECT_EQ(read_all(path).size(), 20000u);

  const std::string whole = test::text_of(path);
  const auto cut = complaint(scratch.write("cut.csv.gz", whole.substr(0, whole.size() / 2)));
  EXPECT_NE(cut.find("cannot be read: "), std::string::npos) << cut;
  EXPECT_NE(cut.find("unexpected end of file; give a complete CSV"), std::string::npos) << cut;

  // Only the checksum at the end tells: all rows would be read.
  const auto tail = complaint(scratch.write("tail.csv.gz", whole.substr(0, whole.size() - 8)));
  EXPECT_NE(tail.find("unexpected end of file"), std::string::npos) << tail;
  std::string flipped = whole;
  flipped[flipped.size() - 6] = static_cast<char>(flipped[flipped.size() - 6] ^ 1);
  const auto sum = complaint(scratch.write("sum.csv.gz", flipped));
  EXPECT_NE(sum.find("incorrect data check"), std::string::npos) << sum;
}

// Bits drawn at random are doubles of all magnitudes, subnormal ones included.
RC_GTEST_PROP(LogWriter, NumbersReadBackExactly,
              (const std::vector<std::uint64_t>& bits, bool zipped)) {
  std::vector<double> numbers;
  for (const std::uint64_t b : bits) {
    const auto number = std::bit_cast<double>(b);
    if (std::abs(number) <= largest_reading) numbers.push_back(number);
  }
  const ScratchFolder scratch;
  const auto path = scratch.path(zipped ? "a.csv.gz" : "a.csv");
  LogWriter writer(path, {"a", "b"});
  for (const double number : numbers) {
    writer.write({number, std::numeric_limits<double>::quiet_NaN()});
  }
  writer.close();
  const auto rows = read_all(path);
  RC_ASSERT(rows.size() == numbers.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    RC_ASSERT(std::bit_cast<std::uint64_t>(rows[i].values[0]) ==
              std::bit_cast<std::uint64_t>(numbers[i]));
    RC_ASSERT(std::isnan(rows[i].values[1]));
  }
}

TEST(LogWriter, NothingAppearsBeforeClose) {
  const ScratchFolder scratch;
  const auto path = scratch.write("a.csv", "old\n1\n");
  {
    LogWriter writer(path, {"new"});
    writer.write({2.0});
  }
  EXPECT_EQ(LogReader(path).columns().front(), "old");
  EXPECT_EQ(
      std::distance(std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()),
                    std::filesystem::directory_iterator()),
      1);
}

TEST(LogWriter, RefusesWhatItCouldNotReadBack) {
  const ScratchFolder scratch;
  const auto path = scratch.path("a.csv");
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{}, {"a", "a"}, {"a", ""}, {"a,b"}, {"a\n"}}) {
    EXPECT_THROW(LogWriter(path, names), InputError);
  }
  EXPECT_THROW(LogWriter(scratch.path("none/a.csv"), {"a"}), InputError);
  LogWriter writer(path, {"a", "b"});
  EXPECT_THROW(writer.write({1.0}), Defect);
  EXPECT_THROW(writer.write({1.0, std::numeric_limits<double>::infinity()}), Defect);
}

std::size_t open_files() {
  const std::filesystem::directory_iterator files("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(Log, FilesAreClosed) {
  const ScratchFolder scratch;
  const std::size_t before = open_files();
  for (const char* name : {"x.csv", "x.csv.gz"}) {
    const auto path = scratch.path(name);
    LogWriter writer(path, {"a"});
    writer.write({1.0});
    writer.close();
    EXPECT_EQ(read_all(path).size(), 1u);
    EXPECT_EQ(open_files(), before);
    {
      const LogReader begun(path);
      EXPECT_EQ(open_files(), before + 1);
      LogWriter given_up(path, {"b"});
      given_up.write({2.0});
    }
    EXPECT_EQ(open_files(), before);
  }
  EXPECT_THROW(LogReader(scratch.write("y.csv", "1,2\n")), InputError);
  EXPECT_EQ(open_files(), before);
}

// Wherever the blocks in which a file is read end, nothing of it is lost.
TEST(LogReader, FilesOfEveryLengthAreReadToTheirLastByte) {
  const ScratchFolder scratch;
  for (const std::size_t block : {std::size_t{1} << 14, std::size_t{1} << 16}) {
    for (std::size_t length = block - 2; length <= block + 2; ++length) {
      std::string text = "a\n";
      while (text.size() + 20 < length) text += "12345\n";
      text += "0.";
      while (text.size() + 1 < length) text += "0";
      text += "7";  // the last byte
      const auto rows = read_all(scratch.write("x.csv", text));
      ASSERT_EQ(text.size(), length);
      ASSERT_EQ(rows.size(), 1 + (length - 22 + 5) / 6) << length;
      EXPECT_GT(rows.back().values[0], 0.0) << length;
    }
  }
}

}  // namespace
}  // namespace shapeid
