// Where the <link> and <joint> elements of a URDF and what they hold stand in the text, so that one
// part can be replaced and all else stay as it was, byte for byte. Internal to models.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace shapeid::urdf {

/// Bytes [begin, end) of a text.
struct Span {
  std::size_t begin = 0, end = 0;
};

struct ElementSpan {
  Span start_tag;            ///< <link name="..."> or <link name="..."/>
  bool self_closed = false;  ///< the latter
  std::vector<Span> parts;   ///< its children of the name that was asked for
};

/// The children `element` of the outermost element, in the order of the text, which must be
/// well-formed XML without declarations (parse_robot has accepted it), each with its children
/// `part`.
[[nodiscard]] std::vector<ElementSpan> find_elements(std::string_view text,
                                                     std::string_view element,
                                                     std::string_view part);

/// A replacement of a part of the text.
struct Edit {
  Span where;
  std::string text;
};

/// The text with all edits made, of which no two overlap.
[[nodiscard]] std::string edited(std::string text, std::vector<Edit> edits);

/// Blanks between the beginning of the line and `at`, if there is nothing else.
[[nodiscard]] std::string indent_before(std::string_view text, std::size_t at);

}  // namespace shapeid::urdf
