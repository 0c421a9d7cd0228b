#include "theorems.hpp"

#include <regex>

namespace {

/// The claim of the comment that ends right before `end`.
std::string claim_above(const std::string& text, std::size_t end) {
  const std::size_t last = text.find_last_not_of(" \n", end - 1);
  if (last == std::string::npos || text.compare(last - 1, 2, "*)") != 0) return "";
  const std::string above = text.substr(0, last);
  const std::string comment = above.substr(above.rfind("(**"));
  const std::regex claim(R"(^\(\*\* Claim (C\d+)\. )");
  std::smatch found;
  return std::regex_search(comment, found, claim) ? found[1].str() : "";
}

}  // namespace

std::map<std::string, std::string> theorems(const std::string& module, const std::string& text) {
  std::map<std::string, std::string> found;
  const std::regex theorem(R"(\n *Theorem (\w+))");
  for (std::sregex_iterator m(text.begin(), text.end(), theorem), end; m != end; ++m) {
    const auto place = static_cast<std::size_t>(m->position());
    found[module + "." + (*m)[1].str()] = claim_above(text, place);
  }
  return found;
}

std::vector<std::string> unproved(const std::string& text) {
  const std::regex word(
      R"(\b(Admitted|admit|give_up|Axioms?|Parameters?|Conjecture|Abort|Declare Module|bypass_check|Unset \w+ Checking)\b)");
  std::vector<std::string> found;
  for (std::sregex_iterator m(text.begin(), text.end(), word), end; m != end; ++m) {
    found.push_back((*m)[1]);
  }
  return found;
}
