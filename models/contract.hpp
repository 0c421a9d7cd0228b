// One contract, three uses: a condition is written once, as a function that says why it does not
// hold. Debug builds check it where it is promised, property tests call it, and proofs name it.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

namespace shapeid {

/// Empty when a condition holds; otherwise one sentence that says what is wrong and by how much.
using Violation = std::optional<std::string>;

/// A defect of ours: a contract did not hold. The command ends with exit status 3.
class Defect : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws Defect with the place and the reason if there is a violation.
void demand(const Violation& violation, const char* file, int line);

/// Whether SHAPEID_CONTRACT checks anything here.
#ifdef NDEBUG
inline constexpr bool contracts_are_checked = false;
#else
inline constexpr bool contracts_are_checked = true;
#endif

}  // namespace shapeid

// The argument is not even evaluated in release builds. The only macro of the libraries besides
// SHAPEID_WIDE and SHAPEID_WIDE_AND_MANY, which mark what is compiled for several processors
// (fast/wide.hpp).
#ifdef NDEBUG
#define SHAPEID_CONTRACT(violation) static_cast<void>(0)
#else
#define SHAPEID_CONTRACT(violation) ::shapeid::demand((violation), __FILE__, __LINE__)
#endif
