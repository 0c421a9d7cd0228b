// What inertias owe to effects that are no causes.
#pragma once

#include <optional>

#include "shapeid/diagnosis/consistent.hpp"

namespace shapeid::diagnosis {

/// Masses and effects fitted once more with those effects alone whose name stands. None if every
/// name does: then it is the model itself.
[[nodiscard]] std::optional<Consistent> beside_causes_alone(const Robot& robot,
                                                            const Recording& log,
                                                            const Recording* reference,
                                                            const LoopSettings& settings,
                                                            const LoopResult& loop);

/// The parameter of the link, 0 to 9, that is another one without the effects that are no causes,
/// by more than three standard errors of both together; of several the one by most of them. The
/// data do not determine it, however small its error is.
[[nodiscard]] std::optional<Eigen::Index> hangs_on_descriptions(const Consistent& model,
                                                                const Consistent& causes_alone,
                                                                int link);

}  // namespace shapeid::diagnosis
