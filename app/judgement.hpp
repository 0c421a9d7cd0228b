// What the exact checker says of a result of `identify` or `load`.
#pragma once

#include "shapeid/app/result.hpp"
#include "shapeid/models/problem_json.hpp"
#include "shapeid/proofs/certificate/certify.hpp"

namespace shapeid::app {

struct Judgement {
  StatedProblem problem;
  Answer answer;
  certificate::Evidence evidence;
  certificate::Certified certified;
};

/// Seeks the limit of infinitely many divisions and the optima over larger sets, and certifies the
/// answer with them.
[[nodiscard]] Judgement judge(const Result& result);

}  // namespace shapeid::app
