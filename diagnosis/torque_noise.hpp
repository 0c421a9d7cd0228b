// How strong the noise of the logged torque and of the accelerometer is, from what is faster than
// the filter.
#pragma once

#include <cstddef>
#include <vector>

#include "shapeid/diagnosis/recording.hpp"
#include "shapeid/diagnosis/rich_model.hpp"

namespace shapeid::diagnosis {

/// A log behind its filter and behind one that leaves more, with the cutoffs (Hz) of both, by the
/// zero-phase filter that logs go through.
struct TwoFilters {
  const Recording& smooth;
  const Recording& rough;
  double cutoff, rough_cutoff;
};

/// Power per Hz, (N m)^2/Hz or N^2/Hz, of each joint's logged torque less what links `Phi` (10
/// each) would need for the accelerometer's reading, between 1.5 times and twice the cutoff, beyond
/// what contact forces can explain, on samples that counted_rows() counts. White noise of either is
/// as strong below; where the robot itself moves as fast, this says more than noise. Of every
/// `stride`-th sample, which must be enough for the rough filter. NaN of a joint of which the log
/// tells too little.
[[nodiscard]] std::vector<double> torque_noise(const Viewer& viewer, const TwoFilters& log,
                                               const Eigen::VectorXd& Phi, std::size_t stride);

}  // namespace shapeid::diagnosis
