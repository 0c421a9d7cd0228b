// problem.json: what is read is written and read back the same.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/problem_json.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::taken([&] {
    const StatedProblem problem = stated_problem_from_json(text, "p.json");
    fuzz::check(!why_malformed(problem), "a problem that was read is well-formed");
    const std::string written = problem_to_json(problem);
    fuzz::check(problem_to_json(stated_problem_from_json(written, "w.json")) == written,
                "a problem reads back the same");
  });
  return 0;
}
