// answer.json: what is read is written and read back the same.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/problem_json.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::taken([&] {
    const Answer answer = answer_from_json(text, "a.json");
    fuzz::check(answer.masses.allFinite() && answer.parameters.allFinite(), "numbers are finite");
    const std::string written = answer_to_json(answer);
    fuzz::check(answer_to_json(answer_from_json(written, "w.json")) == written,
                "an answer reads back the same");
  });
  return 0;
}
