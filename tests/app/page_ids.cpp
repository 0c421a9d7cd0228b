#include "shapeid/tests/app/page_ids.hpp"

#include <algorithm>
#include <regex>

namespace shapeid::test {

std::string PageIds::twice() const {
  std::vector<std::string> sorted = own;
  std::sort(sorted.begin(), sorted.end());
  const auto at = std::adjacent_find(sorted.begin(), sorted.end());
  return at == sorted.end() ? "" : *at;
}

std::string PageIds::missing() const {
  for (const std::string& name : references) {
    if (std::find(own.begin(), own.end(), name) == own.end()) return name;
  }
  return "";
}

PageIds ids_of(const std::string& page) {
  const std::regex own(R"(\sid=['"]([^'"]*)['"])");
  const std::regex reference(R"((?:href=['"]#|url\(#)([^'")]*))");
  const auto all = [](const std::string& tag, const std::regex& what,
                      std::vector<std::string>& names) {
    for (std::sregex_iterator at(tag.begin(), tag.end(), what), end; at != end; ++at) {
      names.push_back((*at)[1]);
    }
  };
  PageIds ids;
  for (std::size_t from = 0; (from = page.find('<', from)) != std::string::npos;) {
    const std::size_t end = std::min(page.find('>', from), page.size());
    const std::string tag = page.substr(from, end - from);
    // Outlines are long, and have no ids.
    if (tag.find("id=") != std::string::npos) all(tag, own, ids.own);
    if (tag.find('#') != std::string::npos) all(tag, reference, ids.references);
    from = end;
  }
  return ids;
}

}  // namespace shapeid::test
