// Where the <link> elements of a URDF and their <inertial> stand in the text, so that one can be
// replaced and all else stay as it was, byte for byte. Internal to models.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace shapeid::urdf {

/// Bytes [begin, end) of a text.
struct Span {
  std::size_t begin = 0, end = 0;
};

struct LinkSpan {
  Span start_tag;            ///< <link name="..."> or <link name="..."/>
  bool self_closed = false;  ///< the latter
  std::optional<Span> inertial;
};

/// The <link> children of the outermost element, in the order of the text, which must be
/// well-formed XML without declarations (parse_robot has accepted it).
[[nodiscard]] std::vector<LinkSpan> find_links(std::string_view text);

}  // namespace shapeid::urdf
