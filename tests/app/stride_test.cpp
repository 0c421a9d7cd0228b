// Which samples of a log the diagnosis takes.
#include <gtest/gtest.h>

#include <vector>

#include "shapeid/app/inputs.hpp"

namespace shapeid::test {
namespace {

app::MotionInputs behind(double cutoff) {
  app::MotionInputs inputs;
  inputs.cutoff = cutoff;
  return inputs;
}

TEST(Stride, LeavesMoreThanFiveSamplesToAPeriodAndFewTooMany) {
  for (const double cutoff : {1.5, 4.0, 5.0, 10.0, 20.0, 47.0}) {
    for (const double rate : {95.0, 100.0, 200.0, 500.0, 1000.0, 1234.0}) {
      const auto stride = static_cast<double>(app::stride_of(behind(cutoff), rate));
      EXPECT_GE(stride, 1.0);
      if (stride > 1.0) {
        EXPECT_GT(rate / stride, 5.0 * cutoff) << rate << " " << cutoff;
      }
      // 5 / 0.999: a quotient just above a whole number counts as below it.
      EXPECT_LE(rate / (stride + 1.0), 5.01 * cutoff) << rate << " " << cutoff;
    }
  }
  EXPECT_EQ(app::stride_of(behind(0.0), 500.0), 1U);
}

/// The rate of a log is one over a difference of times as they are rounded.
TEST(Stride, IsTheSameWheneverTheLogWasBegun) {
  for (const double start : {0.0, 1.7, 37.5, 1e3, 1e5}) {
    for (const double rate : {100.0, 200.0, 400.0, 500.0, 1000.0}) {
      const double as_read = 1.0 / ((start + 1.0 / rate) - start);
      EXPECT_EQ(app::stride_of(behind(20.0), as_read), app::stride_of(behind(20.0), rate))
          << start << " " << rate;
    }
  }
}

}  // namespace
}  // namespace shapeid::test
