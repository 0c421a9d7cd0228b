// What the flags of the cases mean.
#include "shapeid/tests/vectors/make/cases.hpp"

namespace shapeid::vectors {

nlohmann::json flags() {
  return {
      {"NoRotation", "the body does not turn: terms in the angular velocity are not asked for"},
      {"SolidBody", "a cuboid, turned and off the origin"},
      {"TriangleInequalityTight",
       "a plate or a rod but for 1e-5 of its largest moment, on this side or beyond: decided by "
       "the "
       "fifth digit of the tensor"},
      {"TriangleInequalityBroken",
       "mass and tensor are positive, and yet no body has them: one principal moment exceeds the "
       "sum of the others"},
      {"CentreOutside",
       "the tensor about the origin is one of a body, the one about the centre is not"},
      {"Massless", "no mass, but a first moment"},
      {"PartOfAShape", "a cell of the whole: lower and upper bounds of its own coordinates"},
      {"NotConvex", "a closed surface with a hollow: moments are right, divisions are not asked"},
      {"NearlySingular",
       "two directions are one but for 1e-6: more digits are lost, and forgiven, than elsewhere"},
      {"TwoLinks", "bodies of two links in the same rows"},
      {"TiedCriterion",
       "shapes of equal criterion: the one at the smallest place is divided. Another choice is no "
       "bug of the mathematics, but another rule"},
      {"TiedSides",
       "sides of equal length: cut across the axis that comes first. Another choice is no bug of "
       "the mathematics, but another rule"},
      {"NearTheAcceptedGap", "half the accepted gap, or twice"},
      {"RankDeficientJacobian",
       "a force acts through two rows of J: the rank is less than their number. What is projected "
       "away is the same; forces are not unique, and none are compared"},
      {"WithoutNoise", "the optimum is zero up to rounding: only the gap counts"},
      {"ManyShapes",
       "more shapes than parameters: the density term alone says where the mass is. "
       "Judged by the gap, so other masses of nearly the same objective pass"},
      {"NonUniqueMinimiser", "lambda = 0 and more shapes than parameters: any minimiser passes"},
      {"RankDeficientExcitation", "two rows: the data alone leave the masses undetermined"},
      {"MassAtBound", "masses of the optimum are zero: some, or all"},
      {"Optimum", "must be accepted"},
      {"MassPerturbed", "one mass is one percent too large"},
      {"WrongActiveSet", "the heaviest shape is left out"},
      {"NoMass", "m = 0, which certifies itself where the mass bound is taken from the answer"},
      {"NegativeMass", "a mass is negative"},
      {"ParametersOfAnotherBody", "the parameters written beside the masses are not theirs"},
      {"ObjectiveUnderstated", "the objective is said to be half of what it is"},
      {"BeyondTheMassBound", "the masses add up to more than the problem declares"}};
}

}  // namespace shapeid::vectors
