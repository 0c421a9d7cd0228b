// problem.json: what is read is written and read back the same.
#include <cstdint>
#include <string>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/models/problem_json.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto problem = fuzz::accepted([&] { return stated_problem_from_json(text, "p.json"); });
  if (!problem) return 0;
  fuzz::check(!why_malformed(*problem), "a problem that was read is well-formed");
  const std::string written = problem_to_json(*problem);
  const StatedProblem again = stated_problem_from_json(written, "w.json");
  const MassProblem &was = problem->masses, &is = again.masses;
  fuzz::check(is.Y == was.Y && is.F == was.F && is.W == was.W && is.U == was.U && is.V == was.V &&
                  is.lambda == was.lambda && is.mass_bound == was.mass_bound,
              "the masses' problem reads back the same");
  fuzz::check(again.shapes.size() == problem->shapes.size() &&
                  again.regions.size() == problem->regions.size(),
              "no shape and no region is lost");
  fuzz::check(problem_to_json(again) == written, "a problem is written the same again");
  return 0;
}
