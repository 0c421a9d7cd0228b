// What nobody has a name for, as it was found: the number of a law, drawn over a signal.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>

#include "shapeid/diagnosis/effect.hpp"

namespace shapeid::diagnosis {

/// What a curve may be drawn over. The load is what the rigid links ask of the joint
/// (Instant::load), not what was logged.
enum class CurveSignal { position, speed, acceleration, load };

/// A signal of a joint: "q.knee", "dq.knee", "ddq.knee" or "tau.knee".
struct CurveVariable {
  CurveSignal signal = CurveSignal::position;
  int joint = 0;

  friend bool operator==(const CurveVariable&, const CurveVariable&) = default;
};

/// A law of the catalogue at a joint whose one number follows a signal: from knot to knot in
/// straight lines, and constant beyond the first and the last, where nothing was seen. With
/// torque_offset it is a torque over the signal.
struct Curve {
  AppliedEffect law;  ///< that can_follow(); its own value is not used
  CurveVariable over;
  Eigen::VectorXd at;      ///< knots, increasing, two or more: rad, rad/s, rad/s^2 or N m
  Eigen::VectorXd number;  ///< the law's number at each, in its unit
};

/// Whether a law can be that of a curve: one column at a joint, which the instant and
/// predict_torque.hpp know.
[[nodiscard]] bool can_follow(const Effect& effect);

[[nodiscard]] std::string variable_name(const CurveVariable& variable, const Robot& robot);
/// None for names of anything else: time, columns of a log, joints that the robot has not.
[[nodiscard]] std::optional<CurveVariable> find_variable(const std::string& name,
                                                         const Robot& robot);

[[nodiscard]] double value_of(const CurveVariable& variable, const Instant& instant);

/// The share that each knot has in the curve's value at x: zero or positive, one in sum.
[[nodiscard]] Eigen::VectorXd knot_shares(const Eigen::VectorXd& at, double x);

/// What the curve adds to the force that the joints must provide, dof.
[[nodiscard]] Eigen::VectorXd force_of(const Curve& curve, const Instant& instant);

}  // namespace shapeid::diagnosis
