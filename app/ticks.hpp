// Where an axis has ticks, so that their labels do not print over each other.
#pragma once

#include <vector>

namespace shapeid::app {

/// Ends of an axis: those of the data and some room beyond, never the same.
struct Span {
  double low = 0.0, high = 1.0;

  /// Of finite numbers; (0, 1) if there are none.
  [[nodiscard]] static Span around(const std::vector<double>& data);
};

/// The smallest 1, 2 or 5 times a power of ten whose multiples have labels that fit side by side
/// under an axis of so many pixels, in the font of 12 pixels that plots have.
[[nodiscard]] double step_across(const Span& span, double pixels);

/// The same one above the other.
[[nodiscard]] double step_up(const Span& span, double pixels);

/// Ticks of a logarithmic axis between positive ends, labels side by side: 1, 2 and 5 times the
/// powers of ten if they fit, or these powers, or every second of them and so on.
[[nodiscard]] std::vector<double> logarithmic_ticks(const Span& span, double pixels);

}  // namespace shapeid::app
