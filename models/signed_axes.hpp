// Axes of a sensor that are exchanged, or have the other sign.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>

namespace shapeid {

/// Axis i is sign[i] times the logged axis order[i].
struct SignedAxes {
  std::array<int, 3> order{};
  std::array<double, 3> sign{};

  /// What a logged vector is multiplied with.
  [[nodiscard]] Eigen::Matrix3d matrix() const;
  /// "(-x, z, y)"
  [[nodiscard]] std::string words() const;
};

inline constexpr std::size_t signed_axes_count = 48;
/// All of them, left-handed ones too; the logged axes come first.
[[nodiscard]] const std::array<SignedAxes, signed_axes_count>& all_signed_axes();

}  // namespace shapeid
