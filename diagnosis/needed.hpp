// What free parameters can do without and bodies cannot.
#pragma once

#include "shapeid/diagnosis/consistent.hpp"

namespace shapeid::diagnosis {

/// The inertia of a rotor adds to those of the links beyond its joint. If these are free numbers,
/// they take it over, and no error tells of it; if they are bodies of their size, they need a mass
/// for it that they do not have. So if a link's mass is far from the given one, rotors are added to
/// the consistent model at all joints that move it and have none. Those count that differ from zero
/// by more than chance makes of some one of the loop's hypotheses, by the jackknife's few tenths,
/// and they stay, in `loop` and `consistent`, if fewer links are far from the given ones with them.
/// They have no name (Found::needed): links larger than the model says would do as well.
void add_needed_rotors(const Robot& robot, const Recording& log, const Recording* reference,
                       const LoopSettings& settings, LoopResult& loop, Consistent& consistent);

}  // namespace shapeid::diagnosis
