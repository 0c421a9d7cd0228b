// Ids of a page, and what refers to them.
#pragma once

#include <string>
#include <vector>

namespace shapeid::test {

struct PageIds {
  std::vector<std::string> own, references;

  /// The first id that two elements have; empty if each has its own.
  [[nodiscard]] std::string twice() const;
  /// The first reference to an id that no element has; empty if there is none.
  [[nodiscard]] std::string missing() const;
};

/// Of all tags of a page; what stands between them is not looked at.
[[nodiscard]] PageIds ids_of(const std::string& page);

}  // namespace shapeid::test
