// The last step: masses of shapes and points instead of free parameters, so that every link and
// every load is a body that can exist, with the other effects that were found.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/reference/determination.hpp"

namespace shapeid::diagnosis {

struct Consistent {
  RichModel model;
  Eigen::VectorXd Phi_error;  ///< 10 per link: standard errors, zero for known links
  /// Of the free links' parameters, effects fitted along: what the data say without the given
  /// inertias. Empty if no link is free.
  reference::Determination data;
  /// One vector an effect of the model; of a load's numbers that the data cannot tell apart without
  /// its being a body infinite.
  std::vector<Eigen::VectorXd> effect_error;
  /// Likewise, of loads: the error of how large the load is as a whole, one being as it was found.
  /// Its ten numbers may each be badly known, and the load not.
  std::vector<double> load_size_error;
  /// Effects whose sign became impossible when the masses had to be bodies, and loads without mass,
  /// which were left out.
  std::vector<AppliedEffect> dropped;
};

/// Marks what does not differ from zero in the consistent model as it had to when it was accepted:
/// none of its numbers (of a load its size as a whole) is as many standard errors from zero as a
/// normal number is by chance in so few logs as the rule allows, for any of the loop's hypotheses.
void mark_faded(const Recording& log, const LoopSettings& settings, const Consistent& consistent,
                LoopResult& loop);

/// The effects' linear numbers, but for loads', are eliminated exactly (they are free columns), the
/// masses of the settings' shapes and of the loads' points solved and divided by the settings'
/// path, and the effects put back. Given inertias pull as strongly as screening found useful.
/// Errors by leaving out tenths of the log (jackknife).
[[nodiscard]] Consistent make_consistent(const Robot& robot, const Recording& log,
                                         const Recording* reference, const LoopSettings& settings,
                                         const LoopResult& loop);

}  // namespace shapeid::diagnosis
