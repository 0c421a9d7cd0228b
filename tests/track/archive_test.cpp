// What a checkpoint's numbers may be: the library that reads JSON cuts any to the type asked for.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "shapeid/app/track_archive.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

TEST(TrackArchive, WholeNumbersAreWholeAndFit) {
  constexpr auto most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(StateReader::whole<std::uint64_t>(json(most)), most);
  EXPECT_EQ(StateReader::whole<int>(json(-7)), -7);
  EXPECT_EQ(StateReader::whole<std::size_t>(json(0)), 0U);
  for (const json& wrong :
       {json(-1), json(2.5), json(1e300), json(true), json("3"), json(nullptr)}) {
    EXPECT_THROW(static_cast<void>(StateReader::whole<std::size_t>(wrong)), InputError) << wrong;
  }
  for (const json& wrong : {json(most), json(1LL << 31), json(-(1LL << 31) - 1)}) {
    EXPECT_THROW(static_cast<void>(StateReader::whole<int>(wrong)), InputError) << wrong;
  }
}

TEST(TrackArchive, NoMatrixHasAsManyRowsAsADoubleCanSay) {
  Eigen::MatrixXd matrix(2, 3);
  matrix << 1, 2, 3, 4, 5, 6;
  json written = StateWriter::encode(matrix);
  Eigen::MatrixXd read;
  StateReader::decode(written, read);
  EXPECT_EQ(read, matrix);
  for (const char* size : {"rows", "columns"}) {
    json forged = written;
    forged[size] = 1e300;
    EXPECT_THROW(StateReader::decode(forged, read), InputError) << size;
  }
}

}  // namespace
}  // namespace shapeid::app
