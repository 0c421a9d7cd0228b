// The checker as the command uses it, on texts: what a forger can change.
#pragma once

#include <string>
#include <vector>

#include "shapeid/proofs/certificate/certificate_json.hpp"

namespace shapeid::test {

struct Files {
  std::string problem, answer, certificate;  ///< certificate may be empty
};

/// The files of an honest answer. `floor`: with the answer's own parameters as evidence of
/// a floor and of the relaxations.
[[nodiscard]] Files honest_files(const StatedProblem& problem, const Answer& answer, bool floor);

/// Why the answer, or a claim of the certificate, does not stand; empty if all do. Throws
/// InputError for files that cannot be read.
[[nodiscard]] std::vector<std::string> refusals(const Files& files);

/// Whether the files are read, the answer accepted and every claim proved.
[[nodiscard]] bool accepted(const Files& files);

}  // namespace shapeid::test
