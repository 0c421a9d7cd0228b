// The page: prose templates whose numbers come from findings.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "shapeid/tests/experiments/page/findings.hpp"

namespace shapeid::experiments {

struct Page {
  std::string text;
  /// Statements of the template that the numbers do not bear out, and names that they lack, which
  /// leave a question mark. A page with any is not one to publish.
  std::vector<std::string> broken;
};

/// Fills a template in. Between braces stand
///   name            the number, to three digits
///   name:spec       the number in fmt's format; "d" for a count, "%" for a share in percent
///   table name      a table of the findings
///   plot name words the picture name.svg in the folder `pictures`, with words for its title
///   text name       a word from `texts`: the commit, the machine
///   holds a < b     nothing: a statement that the prose around makes; a, b are numbers or names,
///                   the sign is <, <= or =
/// Throws std::invalid_argument for a brace that is not closed and signs that are none, and
/// std::out_of_range for words that `texts` lacks.
[[nodiscard]] Page fill(const std::string& text, const Findings& findings,
                        const std::map<std::string, std::string>& texts,
                        const std::string& pictures);

}  // namespace shapeid::experiments
