#include "shapeid/models/urdf_spans.hpp"

#include <algorithm>

namespace shapeid::urdf {
namespace {

/// The end of what is opened at `begin` and closed by `closing`, which takes nothing of `opening`:
/// in <!--> the comment is still open.
std::size_t after(std::string_view text, std::size_t begin, std::string_view opening,
                  std::string_view closing) {
  const std::size_t found = text.find(closing, begin + opening.size());
  return found == std::string_view::npos ? text.size() : found + closing.size();
}

/// The end of a tag; a '>' between quotes does not close it.
std::size_t after_tag(std::string_view text, std::size_t begin) {
  char quote = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i + 1;
    }
  }
  return text.size();
}

/// Where the name of a tag begins. tinyxml2 takes blanks before it, which XML forbids.
std::size_t after_blanks(std::string_view text, std::size_t tag) {
  return std::min(text.find_first_not_of(" \t\r\n\v\f", tag + 1), text.size());
}

bool starts_with(std::string_view text, std::size_t at, std::string_view what) {
  return text.substr(at, what.size()) == what;
}

/// Whether a tag closes an element. tinyxml2 takes </a/>, which is no XML, for an element <a/>.
bool is_closing(std::string_view text, std::size_t begin, std::size_t end) {
  return starts_with(text, begin, "/") && text[end - 2] != '/';
}

}  // namespace

std::vector<ElementSpan> find_elements(std::string_view text, std::string_view element,
                                       std::string_view part) {
  constexpr int inside_robot = 1;
  constexpr int inside_element = 2;
  std::vector<ElementSpan> found;
  int depth = 0;
  bool in_element = false, in_part = false;
  std::size_t at = text.find('<');
  while (at != std::string_view::npos) {
    std::size_t end = 0;
    const std::size_t begin = after_blanks(text, at);
    if (starts_with(text, at, "<!--")) {
      end = after(text, at, "<!--", "-->");
    } else if (starts_with(text, at, "<![CDATA[")) {
      end = after(text, at, "<![CDATA[", "]]>");
    } else if (starts_with(text, at, "<?")) {
      end = after(text, at, "<?", "?>");
    } else if (is_closing(text, begin, after_tag(text, at))) {
      end = after_tag(text, at);
      --depth;
      if (depth == inside_robot) in_element = false;
      if (in_part && depth == inside_element) {
        found.back().parts.back().end = end;
        in_part = false;
      }
    } else {
      end = after_tag(text, at);
      const std::size_t name_begin = begin + (starts_with(text, begin, "/") ? 1 : 0);
      const std::size_t name_end = std::min(text.find_first_of(" \t\r\n\v\f/>", name_begin), end);
      const std::string_view name = text.substr(name_begin, name_end - name_begin);
      const bool self_closed = text[end - 2] == '/';
      if (depth == inside_robot && name == element) {
        found.push_back({{at, end}, self_closed, {}});
        in_element = !self_closed;
      }
      if (in_element && depth == inside_element && name == part) {
        found.back().parts.push_back({at, end});
        in_part = !self_closed;
      }
      if (!self_closed) ++depth;
    }
    at = text.find('<', end);
  }
  return found;
}

std::string edited(std::string text, std::vector<Edit> edits) {
  // From the end to the beginning, so that earlier places stay where they are.
  std::sort(edits.begin(), edits.end(),
            [](const Edit& a, const Edit& b) { return a.where.begin > b.where.begin; });
  for (const Edit& edit : edits) {
    text.replace(edit.where.begin, edit.where.end - edit.where.begin, edit.text);
  }
  return text;
}

std::string indent_before(std::string_view text, std::size_t at) {
  const std::size_t newline = text.rfind('\n', at);
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  const std::string_view before = text.substr(begin, at - begin);
  const bool blank = before.find_first_not_of(" \t") == std::string_view::npos;
  return blank ? std::string(before) : std::string();
}

}  // namespace shapeid::urdf
