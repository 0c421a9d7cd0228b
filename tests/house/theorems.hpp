// What the files of proofs/ prove, read as text: so it is compared with docs/claims.md without Coq.
#pragma once

#include <map>
#include <string>
#include <vector>

/// "kkt.kkt_suffices" -> "C3": every Theorem of the text of a Coq file called `module`.v, with the
/// claim that the comment right above it begins with; empty if there is none.
[[nodiscard]] std::map<std::string, std::string> theorems(const std::string& module,
                                                          const std::string& text);

/// Words that take something without proof: "Admitted", "Axiom", ... in the order they come.
[[nodiscard]] std::vector<std::string> unproved(const std::string& text);
