// Small helpers of the readers: files, names, and the angles that URDF and our own files share.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <string_view>

#include "shapeid/models/contract.hpp"

namespace shapeid {

/// The whole file. Throws InputError if it is not a regular file that can be read, or has more than
/// `limit` bytes.
[[nodiscard]] std::string read_small_file(const std::string& path, std::size_t limit);

/// The line, from 1, that holds byte `offset`.
[[nodiscard]] int line_at(std::string_view text, std::size_t offset);

/// Why a text cannot name a link, joint or channel ("is empty", ...); empty if it can.
[[nodiscard]] Violation why_no_name(std::string_view name);

/// A text as a terminal shows it in one line: control characters are spelled out (\x0a), and what
/// is longer than `most` bytes is cut. Messages quote files, and a file may hold anything.
[[nodiscard]] std::string one_line(const std::string& text, std::size_t most);

/// rad, of an angle in a file: a turn and its rounding. What is more was meant in degrees.
inline constexpr double largest_angle = 6.3;

/// R = Rz(yaw) Ry(pitch) Rx(roll), angles in rad: URDF's fixed-axis roll, pitch, yaw.
[[nodiscard]] Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy);

}  // namespace shapeid
