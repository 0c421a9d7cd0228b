// Labels of an axis beside each other: as many as there is room for.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "shapeid/app/ticks.hpp"

namespace shapeid::test {
namespace {

using app::Span;

/// Pixels of the widest label at multiples of a step, by the font that plots have: letters of 12
/// pixels are some seven wide.
double widest_label(const Span& span, double step) {
  double widest = 0.0;
  for (double k = std::ceil(span.low / step); k * step <= span.high; ++k) {
    widest = std::max(widest, 7.0 * static_cast<double>(fmt::format("{:g}", k * step).size()));
  }
  return widest;
}

TEST(Ticks, LabelsSideBySideDoNotTouch) {
  // The ellipsoid of a bar on end, lags, a torque of an exact log, a time, a wide range.
  for (const auto& [span, pixels] : std::vector<std::pair<Span, double>>{
           {{-0.14, 0.35}, 46.0},
           {{0.0, 0.4}, 80.0},
           {{-0.0006, 0.0006}, 155.0},
           {{0.0, 1800.0}, 155.0},
           {{-12345.0, 4e5}, 155.0},
       }) {
    const double step = app::step_across(span, pixels);
    const double room = pixels * step / (span.high - span.low);
    EXPECT_GT(room, widest_label(span, step)) << span.low << " " << span.high;
    // A step of a fifth would not do.
    EXPECT_LT(room / 5.0, widest_label(span, step / 5.0) + 20.0) << span.low << " " << span.high;
  }
}

TEST(Ticks, LabelsOneAboveTheOtherDoNotTouch) {
  const Span span{-0.7, 0.1};
  const double step = app::step_up(span, 180.0);
  constexpr double line = 14.0;  // pixels
  EXPECT_GT(180.0 * step / 0.8, line);
  EXPECT_LT(180.0 * step / 0.8, 5.0 * line);
}

TEST(Ticks, AnAxisOfWhatDoesNotMoveHasTwoEnds) {
  for (const double x : {0.0, 1e-9, -3.0, 7e8}) {
    const Span span = Span::around({x, x});
    EXPECT_LT(span.low, x);
    EXPECT_GT(span.high, x);
    EXPECT_GT(app::step_across(span, 150.0), 0.0);
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Span span = Span::around({none, -2.0, 5.0});
  EXPECT_LT(span.low, -2.0);
  EXPECT_GT(span.high, 5.0);
  EXPECT_LT(Span::around({none}).low, Span::around({none}).high);
}

/// One tick is no scale: labels come closer rather.
TEST(Ticks, AnAxisWithRoomForTwoLabelsHasTwo) {
  for (const auto& [span, pixels] : std::vector<std::pair<Span, double>>{
           {{-0.009, 0.008}, 160.0}, {{-0.45, 0.6}, 60.0}, {{1.2, 2.9}, 90.0}}) {
    const double step = app::step_across(span, pixels);
    const double ticks = std::floor(span.high / step) - std::ceil(span.low / step) + 1.0;
    EXPECT_GE(ticks, 2.0) << span.low << " " << span.high << " " << step;
    EXPECT_GT(pixels * step / (span.high - span.low), widest_label(span, step));
  }
}

TEST(Ticks, OfALogarithmicAxis) {
  EXPECT_EQ(app::logarithmic_ticks({0.15, 2.6}, 600.0), (std::vector<double>{0.2, 0.5, 1.0, 2.0}));
  // Powers of ten alone where there is no room for more, and every second one if need be.
  const auto decades = app::logarithmic_ticks({3e-5, 4.0}, 330.0);
  ASSERT_EQ(decades.size(), 5U);
  EXPECT_DOUBLE_EQ(decades.front(), 1e-4);
  EXPECT_DOUBLE_EQ(decades.back(), 1.0);
  const auto few = app::logarithmic_ticks({3e-17, 4.0}, 600.0);
  ASSERT_GT(few.size(), 2U);
  EXPECT_GE(few[1] / few[0], 99.0);
  // Where no 1, 2 or 5 lies, or one alone, even steps.
  EXPECT_GE(app::logarithmic_ticks({2.1, 4.6}, 600.0).size(), 3U);
  const auto beside_five = app::logarithmic_ticks({4.0, 9.0}, 600.0);
  ASSERT_GE(beside_five.size(), 3U);
  EXPECT_DOUBLE_EQ(beside_five[0], 4.0);
}

}  // namespace
}  // namespace shapeid::test
