#include "shapeid/tests/experiments/data/errors.hpp"

#include <cmath>

namespace shapeid::experiments {

ParameterError parameter_error(const Vector10& found, const Vector10& truth) {
  const Vector10 e = found - truth;
  return {std::abs(e[0]), e.segment<3>(1).norm(), e.tail<6>().norm(), e.norm()};
}

}  // namespace shapeid::experiments
