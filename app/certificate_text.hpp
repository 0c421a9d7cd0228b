// What was proved of an answer, in words.
#pragma once

#include <string>

#include "shapeid/proofs/certificate/certify.hpp"

namespace shapeid::app {

[[nodiscard]] std::string certified_text(const certificate::Certified& certified);

}  // namespace shapeid::app
