// What free parameters can do without and bodies cannot.
#pragma once

#include "shapeid/diagnosis/consistent.hpp"

namespace shapeid::diagnosis {

/// Free numbers may say a force, an offset or a spring; bodies of their size cannot, and if they
/// predict the log worse by more than chance, something is there that the free numbers hide. Of
/// what they hide that is tried in the consistent model which gives back nearly all of what bodies
/// lack, comes out credible and differs from zero as it must in a selection: of those that cannot
/// be told from the best the one with fewest numbers, the others named beside it. It comes into
/// `loop` and `consistent`, as Found::hangs_on_given; a rotor as Found::needed, for it might be
/// larger links. Again beside it, if bodies still lack something.
void add_needed_causes(const Robot& robot, const Recording& log, const Recording* reference,
                       const LoopSettings& settings, LoopResult& loop, Consistent& consistent);

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
