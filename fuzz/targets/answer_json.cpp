// answer.json: what is read is written and read back the same.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/problem_json.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto answer = fuzz::accepted([&] { return answer_from_json(text, "a.json"); });
  if (!answer) return 0;
  fuzz::check(answer->masses.allFinite() && answer->parameters.allFinite(), "numbers are finite");
  const std::string written = answer_to_json(*answer);
  const Answer again = answer_from_json(written, "w.json");
  fuzz::check(again.problem_digest == answer->problem_digest && again.masses == answer->masses &&
                  again.parameters == answer->parameters && again.objective == answer->objective,
              "an answer reads back the same");
  fuzz::check(answer_to_json(again) == written, "an answer is written the same again");
  return 0;
}
