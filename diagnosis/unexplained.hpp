// What no effect explains: does the residual follow some signal, and by which curve?
#pragma once

#include <string>
#include <vector>

#include "shapeid/diagnosis/constancy.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/strangers.hpp"

namespace shapeid::diagnosis {

/// A curve of the residual of one joint over one signal.
struct Structure {
  std::string joint;
  std::string variable;  ///< "q.knee", "dq.hip", "ddq.knee", "tau.knee", its "dtau.knee" and
                         ///< "turn.knee" (Recording::turned), "time", a log column,
                         ///< or "frequency": none of these, but slow (slowness.hpp)
  /// Of the joint's residual variance, on blocks that were not used; of an effect whose number
  /// follows the signal: of what that effect is worth.
  double share = 0.0;
  double t = 0.0;                 ///< over its standard error
  std::vector<double> at, value;  ///< the empirical curve: middle of each bin, mean residual
  std::string under_name;         ///< the effect that was accepted and does not stay constant
  /// "torque_gain@knee": the curve is of this law's number over the signal, in the law's unit; else
  /// empty, and it is of the residual.
  std::string law, law_unit;
};

/// Tests the residual of every joint against its own position, velocity, acceleration and torque,
/// the other joints' positions and velocities, time, and every extra column: a smooth curve is
/// fitted on some blocks of time and judged on the others. What passes is returned, the strongest
/// first, at most one variable for each joint and kind of signal. The series is of every stride-th
/// sample.
[[nodiscard]] std::vector<Structure> unexplained(const Robot& robot, const Recording& recording,
                                                 const Series& series, std::size_t stride);

/// What followed a signal under the name of an effect: the curve of the residual without it over
/// the signal that its number follows.
[[nodiscard]] Structure unnamed(const Robot& robot, const Recording& recording,
                                const Series& without, const Variation& variation);

/// What a law without a name explains: the curve of its carrier's number over the signal that the
/// number follows, by what `model`, which lacks it, leaves in the row of its joint.
[[nodiscard]] Structure lawless(const Robot& robot, RowSource source, const RichModel& model,
                                const Recording& recording, std::size_t stride,
                                const Stranger& stranger);

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
