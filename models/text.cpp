#include "shapeid/models/text.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

/// Number of bytes that a lead byte announces after itself, and the range of the next one (which is
/// narrower where a wider one would spell overlong forms, surrogates, or more than U+10FFFF).
struct Tail {
  std::size_t bytes;
  unsigned char lowest, highest;
};

std::optional<Tail> tail_after(unsigned char lead) {
  if (lead < 0x80) return Tail{0, 0, 0};
  if (lead < 0xC2 || lead > 0xF4) return std::nullopt;
  if (lead < 0xE0) return Tail{1, 0x80, 0xBF};
  if (lead < 0xF0) {
    return Tail{2, static_cast<unsigned char>(lead == 0xE0 ? 0xA0 : 0x80),
                static_cast<unsigned char>(lead == 0xED ? 0x9F : 0xBF)};
  }
  return Tail{3, static_cast<unsigned char>(lead == 0xF0 ? 0x90 : 0x80),
              static_cast<unsigned char>(lead == 0xF4 ? 0x8F : 0xBF)};
}

/// Results are written as JSON and HTML, which must be UTF-8 (RFC 3629, section 4).
bool is_utf8(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::optional<Tail> tail = tail_after(byte(i));
    if (!tail || i + tail->bytes >= text.size()) return false;
    for (std::size_t k = 1; k <= tail->bytes; ++k) {
      const unsigned char lowest = k == 1 ? tail->lowest : 0x80;
      const unsigned char highest = k == 1 ? tail->highest : 0xBF;
      if (byte(i + k) < lowest || byte(i + k) > highest) return false;
    }
    i += tail->bytes;
  }
  return true;
}

}  // namespace

std::string read_small_file(const std::string& path, std::size_t limit) {
  const Place place{path, 0, {}};
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(place, "no such file, or not a regular one", "check the path");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(place, "cannot be opened", "check its permissions");
  // In blocks, and the size that the file system states is not asked: it may change meanwhile.
  std::string text;
  std::array<char, 65536> block{};
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > limit) {
      throw InputError(place, fmt::format("larger than {} bytes", limit),
                       "is this the right file?");
    }
  }
  if (in.bad()) throw InputError(place, "reading failed", "check the disk");
  return text;
}

int line_at(std::string_view text, std::size_t offset) {
  return 1 + static_cast<int>(std::count(text.begin(),
                                         text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
}

Violation why_no_name(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.front() == ' ' || name.back() == ' ') return "has blanks around it";
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(name.begin(), name.end(), is_control)) return "has a control character";
  if (!is_utf8(name)) return "is not UTF-8 text";
  return std::nullopt;
}

std::string one_line(const std::string& text, std::size_t most) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool control = byte < 0x20 || byte == 0x7F;
    // Inside a character of UTF-8, three bytes behind its first at most, is no place to cut.
    const bool inside_character = (byte & 0xC0U) == 0x80U && result.size() < most + 3;
    if (result.size() >= most && !inside_character) return result + "...";
    result += control ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return result;
}

Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace shapeid
