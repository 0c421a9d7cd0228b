// Claim C19. What an inertia would owe to an effect that is there and was too small to be found.
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/consistent.hpp"

namespace shapeid::diagnosis {

struct Unnoticed {
  /// 10 per link: root of the mean square error that a number has if the effect that moves it most
  /// is there, as large as the data allow, and of what a slower filter moves it by, if it was
  /// asked; never below its standard error. Zero for known links.
  Eigen::VectorXd error;
  std::vector<std::string> effect;  ///< 10 per link: that effect; empty where none moves the number
};

/// A standard error takes for granted that nothing acts but what was found. A rotor's inertia that
/// is not found leaves no residual: the link's own inertia has taken it. So each hypothesis of the
/// catalogue that is not in the model is fitted along, alone. Of its number theta, estimated with
/// an error s, E[theta^2] = theta^2 + s^2, and an inertia that moves by b per unit of theta was
/// wrong by b theta. What cannot be told from inertias at all may have its usual size, or, if it
/// has no range in which it is believed, one that moves no inertial number further than by
/// LoopSettings::size.
/// `settings` and `loop` are those of the model; `log` carries the loop's correction.
[[nodiscard]] Unnoticed unnoticed(const Robot& robot, const Recording& log,
                                  const Recording* reference, const LoopSettings& settings,
                                  const LoopResult& loop, const Consistent& consistent);

/// What noise of motion and the filter have done to a number scatters no more than they do: of that
/// the scatter between tenths of a log says nothing. `moves`: moves_behind() of the model, for the
/// numbers of the sought links.
void allow_for_filter(const Eigen::VectorXd& moves, const std::vector<int>& free_links,
                      Unnoticed& unnoticed);

/// Whether the link's mass is below half or above twice the given one, by more than three of
/// `error` (10 per link; Unnoticed's, if there is one). One of the two is wrong then, and the log
/// does not say which: effects without a name, taken for granted, may carry most of a body.
[[nodiscard]] bool is_far_from_given(const Robot& robot, const Consistent& consistent,
                                     const Eigen::VectorXd& error, int link);
/// The same of a free link (by its place) whose mass the data determine: what they do not, another
/// number of the link or a bound may have moved.
[[nodiscard]] bool is_surely_far_from_given(const Robot& robot, const std::vector<int>& free_links,
                                            const Consistent& consistent,
                                            const Eigen::VectorXd& error, std::size_t place);

}  // namespace shapeid::diagnosis
