#include "shapeid/app/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace shapeid::app {
namespace {

// Pixels of a font of 12: the widest digit of common fonts, and room to tell neighbours apart.
constexpr double digit_pixels = 7.7, line_pixels = 20.0, room_between_labels = 10.0,
                 room_between_lines = 6.0;
constexpr std::array<double, 3> round_numbers = {1.0, 2.0, 5.0};

double label_width(double x) {
  return digit_pixels * static_cast<double>(fmt::format("{:g}", x).size());
}

/// The first step whose labels take no more than the axis has. One tick is no scale: rather than
/// that, labels come closer, by as much as `room` that they have between them.
template <typename Length>
double smallest_step(const Span& span, double pixels, const Length& length, double room) {
  constexpr double too_many = 50.0;
  const double range = span.high - span.low;
  double of_two_ticks = 0.0;  // the largest step that has them so
  for (int power = static_cast<int>(std::floor(std::log10(range / too_many)));; ++power) {
    for (const double number : round_numbers) {
      const double step = number * std::pow(10.0, power);
      const double first = std::ceil(span.low / step);
      const auto ticks = static_cast<int>(std::floor(span.high / step) - first) + 1;
      double longest = 0.0;
      for (int k = 0; k < ticks; ++k) longest = std::max(longest, length((first + k) * step));
      const double apart = step * pixels / range;
      if (ticks > 1 && apart >= longest - room) of_two_ticks = step;
      if (apart < longest && step <= range) continue;
      return ticks > 1 || of_two_ticks == 0.0 ? step : of_two_ticks;
    }
  }
}

}  // namespace

Span Span::around(const std::vector<double>& data) {
  constexpr double beyond = 0.04;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double x : data) {
    if (!std::isfinite(x)) continue;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  if (!(low <= high)) return {};
  // What does not move is in the middle of an axis on which five digits tell its ends apart.
  const double size = std::max(std::abs(low), std::abs(high));
  const double least = size > 0.0 ? 1e-3 * size : 1.0;
  const double room = std::max(beyond * (high - low), 0.5 * (least - (high - low)));
  return {low - room, high + room};
}

double step_across(const Span& span, double pixels) {
  return smallest_step(
      span, pixels, [](double x) { return label_width(x) + room_between_labels; },
      room_between_labels);
}

double step_up(const Span& span, double pixels) {
  return smallest_step(
      span, pixels, [](double) { return line_pixels; }, room_between_lines);
}

std::vector<double> logarithmic_ticks(const Span& span, double pixels) {
  const int first = static_cast<int>(std::floor(std::log10(span.low)));
  const int last = static_cast<int>(std::floor(std::log10(span.high)));
  const auto ticks_of = [&](std::size_t numbers, int every) {
    std::vector<double> ticks;
    for (int power = first; power <= last; ++power) {
      if (power % every != 0) continue;
      for (std::size_t i = 0; i < numbers; ++i) {
        const double x = round_numbers[i] * std::pow(10.0, power);
        if (x >= span.low && x <= span.high) ticks.push_back(x);
      }
    }
    return ticks;
  };
  const double scale = pixels / std::log10(span.high / span.low);
  const auto fit = [&](const std::vector<double>& ticks) {
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      const double room = scale * std::log10(ticks[i] / ticks[i - 1]);
      if (room < 0.5 * (label_width(ticks[i]) + label_width(ticks[i - 1])) + room_between_labels)
        return false;
    }
    return true;
  };
  std::vector<double> ticks = ticks_of(round_numbers.size(), 1);
  for (int every = 1; !fit(ticks); ++every) ticks = ticks_of(1, every);
  if (ticks.size() > 1) return ticks;
  // Less than a decade, with no two of them: as on any other axis.
  const double step = step_across(span, pixels);
  std::vector<double> even;
  for (double k = std::ceil(span.low / step); k * step <= span.high; ++k) even.push_back(k * step);
  return fit(even) && even.size() > ticks.size() ? even : ticks;
}

}  // namespace shapeid::app
