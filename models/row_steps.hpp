// How far apart in time a log's rows, and the measurements of its channels, usually are.
#pragma once

#include <Eigen/Core>

#include <deque>
#include <string>
#include <vector>

#include "shapeid/models/channels.hpp"

namespace shapeid {

/// A channel's step longer than so many of its median steps is a gap. (Of a log with holes of
/// exactly five steps some are gaps and some are not, by the rounding of times:
/// docs/derivations/diagnosis-history.md, holes.)
inline constexpr double gap_steps = 5.0;

/// Of one number at least.
[[nodiscard]] double median(std::vector<double> values);

/// Median time between the rows, s; 0 for a single one. Where the times are so large that their
/// rounding shows in it, the mean of all that are within the rounding.
[[nodiscard]] double median_row_step(const std::deque<MeasuredRow>& head);

/// Median time between the measurements of every channel, s. Throws InputError, which names `path`,
/// for a channel with less than two.
[[nodiscard]] Eigen::VectorXd median_steps(const std::deque<MeasuredRow>& head,
                                           const ChannelPlan& plan, const std::string& path);

}  // namespace shapeid
