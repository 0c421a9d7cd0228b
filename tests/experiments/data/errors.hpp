// How far found parameters are from the truth, each group in its own unit.
#pragma once

#include "shapeid/models/inertia.hpp"

namespace shapeid::experiments {

struct ParameterError {
  double mass = 0.0;          ///< kg
  double first_moment = 0.0;  ///< kg m
  double tensor = 0.0;        ///< kg m^2, of its six numbers, about the link's origin
  double published = 0.0;     ///< the paper's: 2-norm of all ten numbers, units mixed
};

[[nodiscard]] ParameterError parameter_error(const Vector10& found, const Vector10& truth);

}  // namespace shapeid::experiments
