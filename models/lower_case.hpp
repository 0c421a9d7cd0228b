// Words whose capitals say nothing.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace shapeid {

/// A to Z as a to z; all other bytes as they are.
[[nodiscard]] inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace shapeid
