// certificate.json: what is claimed of an answer, apart from the evidence it is proved from.
// Schema: docs/formats/certificate.md.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "shapeid/proofs/certificate/certify.hpp"

namespace shapeid::certificate {

struct Certificate {
  nlohmann::json claim;  ///< of the proof, as proof_json() writes it
  Evidence evidence;
};

/// Infinite numbers are null.
[[nodiscard]] nlohmann::json proof_json(const Proof& proof);

[[nodiscard]] std::string certificate_to_json(const Proof& proof, const Evidence& evidence);

/// Throws InputError for anything that is not a certificate of this problem's size.
[[nodiscard]] Certificate certificate_from_json(const std::string& text, const std::string& name,
                                                const StatedProblem& problem);

/// Every claim that is not what the proof says, one sentence each. `evidence` is the certificate's.
[[nodiscard]] std::vector<std::string> false_claims(const Certificate& certificate,
                                                    const Proof& proof);

}  // namespace shapeid::certificate
