// Claim C16. What a filter makes of products: the dynamics of filtered signals are not the filtered
// dynamics.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// Forces that the model asks for with filtered signals, less what it asks for filtered, one vector
/// (dof) a sample of `smooth`; zero where `rough` has no sample. `rough` is the same log, filtered
/// at a higher cutoff: its motion stands for the true one, and so do the contact forces with which
/// the model comes closest to its torque. A force that the filter smears beyond the time in which
/// its contact counts as touching is part of the error. `cutoff` in Hz is that of `smooth`, by the
/// zero-phase filter of second order that logs go through.
[[nodiscard]] std::vector<Eigen::VectorXd> filter_error(const Viewer& viewer,
                                                        const RichModel& model,
                                                        const Recording& smooth,
                                                        const Recording& rough, double cutoff);

}  // namespace shapeid::diagnosis
