// What no effect explains: does the residual follow some signal, and by which curve?
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/series.hpp"

namespace shapeid::diagnosis {

/// A curve of the residual of one joint over one signal.
struct Structure {
  std::string joint;
  std::string variable;  ///< "q.knee", "dq.hip", "ddq.knee", "tau.knee", "time", or a log column
  double share = 0.0;    ///< of the joint's residual variance, on blocks that were not used
  double t = 0.0;        ///< over its standard error
  std::vector<double> at, value;  ///< the empirical curve: middle of each bin, mean residual
};

/// Tests the residual of every joint against its own position, velocity, acceleration and torque,
/// the other joints' positions and velocities, time, and every extra column: a curve of ten bins is
/// fitted on some blocks of time and judged on the others. What passes is returned, the strongest
/// first, at most one variable for each joint and kind of signal.
[[nodiscard]] std::vector<Structure> unexplained(const Robot& robot, const Recording& recording,
                                                 const Series& series);

/// Autocorrelation of a row of the series at the first `lags` lags (samples apart), and the band
/// in which that of white noise stays with 95 percent.
struct Autocorrelation {
  std::vector<double> value;
  double band = 0.0;
  double step = 0.0;  ///< s from lag to lag
};
[[nodiscard]] Autocorrelation autocorrelation(const Recording& recording, const Series& series,
                                              Eigen::Index row, int lags);

}  // namespace shapeid::diagnosis
