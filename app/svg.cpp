#include "shapeid/app/svg.hpp"

#include <array>
#include <set>
#include <string_view>
#include <utility>

namespace shapeid::app {
namespace {

using Ids = std::set<std::string, std::less<>>;

/// What an attribute or a style begins with, up to the name of an id.
constexpr std::array<std::string_view, 2> before_own_id = {" id='", " id=\""};
constexpr std::array<std::string_view, 3> before_other_id = {"href='#", "href=\"#", "url(#"};

/// Calls `change` for every tag; what stands between tags may look like one of its attributes,
/// whatever a joint is called, and stays as it is.
template <typename Change>
std::string with_tags(std::string_view svg, const Change& change) {
  std::string text;
  std::size_t from = 0;
  while (true) {
    const std::size_t begin = svg.find('<', from);
    const std::size_t end =
        begin == std::string_view::npos ? std::string_view::npos : svg.find('>', begin);
    if (end == std::string_view::npos) return text.append(svg.substr(from));
    text.append(svg.substr(from, begin - from));
    text += change(std::string(svg.substr(begin, end + 1 - begin)));
    from = end + 1;
  }
}

std::string_view id_at(std::string_view tag, std::size_t at) {
  return tag.substr(at, tag.find_first_of("'\")", at) - at);
}

void note_references(const std::string& tag, Ids& ids) {
  for (const std::string_view start : before_other_id) {
    for (std::size_t at = tag.find(start); at != std::string_view::npos;
         at = tag.find(start, at + 1)) {
      ids.emplace(id_at(tag, at + start.size()));
    }
  }
}

std::string with_prefix(std::string tag, const Ids& wanted, const std::string& prefix) {
  for (const std::string_view start : before_other_id) {
    for (std::size_t at = tag.find(start); at != std::string_view::npos;
         at = tag.find(start, at + 1)) {
      tag.insert(at + start.size(), prefix);
    }
  }
  for (const std::string_view start : before_own_id) {
    const std::size_t at = tag.find(start);
    if (at == std::string_view::npos) continue;
    const std::string_view id = id_at(tag, at + start.size());
    if (wanted.contains(id)) {
      tag.insert(at + start.size(), prefix);
    } else {
      tag.erase(at, start.size() + id.size() + 1);
    }
  }
  return tag;
}

}  // namespace

std::string without_titles(const std::string& svg) {
  const std::string opening = "<title>", closing = "</title>";
  std::string bare;
  std::size_t from = 0;
  while (true) {
    const std::size_t begin = svg.find(opening, from);
    const std::size_t end =
        begin == std::string_view::npos ? std::string_view::npos : svg.find(closing, begin);
    if (end == std::string_view::npos) return bare + svg.substr(from);
    bare += svg.substr(from, begin - from);
    from = end + closing.size();
  }
}

std::string with_own_ids(const std::string& svg, const std::string& prefix) {
  Ids wanted;
  with_tags(svg, [&](const std::string& tag) {
    note_references(tag, wanted);
    return tag;
  });
  return with_tags(svg,
                   [&](std::string tag) { return with_prefix(std::move(tag), wanted, prefix); });
}

}  // namespace shapeid::app
