// What is usually fitted, to compare with.
#pragma once

#include "shapeid/diagnosis/loop.hpp"

namespace shapeid::diagnosis {

/// Masses and, at every joint, viscous and Coulomb friction, an offset and a rotor's inertia: least
/// squares of all blocks with the loop's weights and prior. Nothing is selected, no sign asked for,
/// and links need not be bodies.
[[nodiscard]] RichModel usual_model(const Robot& robot, const Recording& log,
                                    const LoopSettings& settings, const LoopResult& loop);

}  // namespace shapeid::diagnosis
