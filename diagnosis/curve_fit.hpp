// Curves for what no effect explains.
#pragma once

#include <vector>

#include "shapeid/diagnosis/curve.hpp"
#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/recording.hpp"

namespace shapeid::diagnosis {

/// The curves that `model` lacks, fitted beyond what contact forces explain: first the laws whose
/// numbers follow a signal, as the loop found them (Found::varies and strangers); then, until there
/// is no more, torque over each signal of a joint that the residual follows on blocks that were
/// left out (unexplained()). Not over time, other columns of the log, or the way since a joint
/// turned round: a model cannot predict with these. `model` has no curves yet. Of the joints that
/// are `silent` what the residual follows is none.
[[nodiscard]] std::vector<Curve> curves_for(const Robot& robot, RowSource source, RichModel model,
                                            const LoopResult& loop, const Recording& recording,
                                            std::size_t stride,
                                            const std::vector<std::string>& silent = {});

}  // namespace shapeid::diagnosis
