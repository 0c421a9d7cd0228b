#include "shapeid/diagnosis/torque_columns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/rich_model.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/motion_extent.hpp"
#include "shapeid/models/value_range.hpp"

namespace shapeid::diagnosis {
namespace {

/// What feet push against each other is left out on a floating base: it is known from torque, and
/// would follow that at any scale.
Eigen::VectorXd load_without_torque(const Viewer& viewer, const View& view,
                                    const RichModel& given) {
  if (viewer.robot().root == Root::fixed) return predict(viewer, view, given).load.joint;
  const Eigen::VectorXd carried = view.Y * given.Phi - view.carried;
  const Eigen::VectorXd f = carrying_forces(viewer.robot(), carried, view.J);
  return (carried - view.J.transpose() * f).tail(viewer.robot().joint_count());
}

/// Products of what is predicted (p) and logged (t), summed over samples.
struct Products {
  Eigen::MatrixXd pt;      ///< joints x joints
  Eigen::VectorXd pp, tt;  ///< of each joint
};

Products products_of(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  const RichModel given{stacked_parameters(robot), {}};
  const Viewer viewer(robot, contacts, {});
  const Eigen::Index n = robot.joint_count();
  Products sums{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (const std::size_t i : recording.usable(recording.stride_of(2000))) {
    const View view = viewer.view(recording, i);
    const Eigen::VectorXd load = load_without_torque(viewer, view, given);
    sums.pt += load * view.sample.tau.transpose();
    sums.pp += load.cwiseAbs2();
    sums.tt += view.sample.tau.cwiseAbs2();
  }
  return sums;
}

void check_scale(const Robot& robot, const Products& sums) {
  // Joints whose torque the given model follows closely tell the scale; friction and errors of
  // inertia do not make a factor of four at all of them.
  constexpr double close = 0.8, far = 4.0;
  int telling = 0, above = 0, below = 0;
  std::vector<std::string> against;
  double typical = 0.0;
  for (Eigen::Index j = 0; j < robot.joint_count(); ++j) {
    const double pt = sums.pt(j, j);
    const double correlation = pt / std::sqrt(std::max(sums.pp[j] * sums.tt[j], 1e-300));
    if (!(std::abs(correlation) > close)) continue;
    const double scale = pt / sums.pp[j];
    ++telling;
    if (scale < 0.0) {
      against.push_back(robot.joint(static_cast<int>(j)).name);
      continue;
    }
    if (scale > far) ++above;
    if (scale < 1.0 / far) ++below;
    typical += std::log(scale);
  }
  if (telling == 0) return;
  if (std::ssize(against) == telling) {
    throw Refusal(
        "torque-sign",
        fmt::format("the logged torque runs against the given model at {}, and with it at "
                    "no joint: turn it in the mapping (sign: -1), or the joint, if its "
                    "axis points the other way{}",
                    fmt::join(against, ", "),
                    robot.root == Root::fixed
                        ? " or its zero is half a turn off, or the base in the URDF, if "
                          "it hangs upside down"
                        : ""));
  }
  if (above == telling || below == telling) {
    throw Refusal(
        "torque-scale",
        fmt::format("the logged torque follows the given model at {} joint{}, but is {:.2g} times "
                    "as large: another unit than N m, a current or the motor's torque (declare it "
                    "in the mapping: scale, or torque: kind, factor), or given masses that "
                    "are as far off (give about right ones)",
                    telling, telling == 1 ? "" : "s", std::exp(typical / telling)));
  }
}

void check_order(const Robot& robot, const Products& sums) {
  // Legs that move alike do not tell; links that are given wrong make no quarter of an error.
  constexpr double far_better = 0.25;
  // Of the squared torque: what is left below a tenth of its rms is no exchange, and in the logs of
  // a simulator it is the rounding of these differences.
  constexpr double badly = 0.01;
  double least = far_better;
  Eigen::Index first = -1, second = -1;
  for (Eigen::Index a = 0; a < robot.joint_count(); ++a) {
    for (Eigen::Index b = a + 1; b < robot.joint_count(); ++b) {
      const double squares = sums.pp[a] + sums.pp[b] + sums.tt[a] + sums.tt[b];
      const double own = squares - 2.0 * (sums.pt(a, a) + sums.pt(b, b));
      if (!(own > badly * (sums.tt[a] + sums.tt[b]))) continue;
      const double other = squares - 2.0 * (sums.pt(a, b) + sums.pt(b, a));
      // Well enough to be a prediction at all, too.
      const double share = other / std::min(own, sums.tt[a] + sums.tt[b]);
      if (!(share < least)) continue;
      least = share;
      first = a;
      second = b;
    }
  }
  if (first < 0) return;
  throw Refusal("torque-order",
                fmt::format("the logged torque of {} follows what the given model predicts at {}, "
                            "and the other way round: exchange them in the mapping, or their "
                            "joints in the URDF",
                            robot.joint(static_cast<int>(first)).name,
                            robot.joint(static_cast<int>(second)).name));
}

/// Of one joint, summed over samples: squares of what the given links need of it, of the part that
/// its own acceleration takes, and of the rest.
struct Parts {
  double all = 0.0, own = 0.0, rest = 0.0;
};

}  // namespace

std::vector<int> silent_joints(const Robot& robot, const Recording& recording) {
  std::vector<int> silent;
  bool any_torque = false;
  for (int j = 0; j < robot.joint_count(); ++j) {
    ValueRange positions, torques;
    for (const Sample& s : recording.samples()) {
      positions.add(s.q[j]);
      torques.add(s.tau[j]);
    }
    const bool is_zero = torques.least == 0.0 && torques.most == 0.0;
    any_torque = any_torque || !is_zero;
    if (is_zero && moved_far(robot.joint(j), positions.width())) silent.push_back(j);
  }
  // No torque at all is refused when the log is read (models/plausibility.hpp).
  if (!any_torque) silent.clear();
  return silent;
}

void check_silent_torques(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts) {
  const std::vector<int> silent = silent_joints(robot, recording);
  if (silent.empty()) return;

  const RichModel given{stacked_parameters(robot), {}};
  const Viewer viewer(robot, contacts, {});
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(robot.joint_count());
  std::vector<Parts> parts(silent.size());
  const std::vector<std::size_t> looked_at = recording.usable(recording.stride_of(2000));
  for (const std::size_t i : looked_at) {
    const View view = viewer.view(recording, i);
    const Eigen::VectorXd load = load_without_torque(viewer, view, given);
    squares += load.cwiseAbs2();
    for (std::size_t k = 0; k < silent.size(); ++k) {
      const int j = silent[k];
      Sample coasting = view.sample;
      coasting.ddq[j] = 0.0;
      const View without = viewer.view(std::move(coasting), view.surroundings);
      const double rest = load_without_torque(viewer, without, given)[j];
      parts[k].all += load[j] * load[j];
      parts[k].own += (load[j] - rest) * (load[j] - rest);
      parts[k].rest += rest * rest;
    }
  }
  // Parts that balance leave nothing, and with links that are given a third wrong a tenth of their
  // squares; parts that have nothing to do with each other leave all. What is little beside the
  // other joints is friction of a wheel.
  constexpr double balanced = 0.5, little = 0.05;
  for (std::size_t k = 0; k < silent.size(); ++k) {
    const int j = silent[k];
    if (parts[k].all <= balanced * (parts[k].own + parts[k].rest)) continue;
    if (std::sqrt(parts[k].all) <= little * std::sqrt(squares.maxCoeff())) continue;
    const bool slides = robot.joint(j).kind == JointKind::prismatic;
    throw Refusal("torque-missing",
                  fmt::format("the torque of {} is zero throughout, where the given model needs "
                              "{:.2g} {}, and a joint that nothing drives would move otherwise: "
                              "log it",
                              robot.joint(j).name,
                              std::sqrt(parts[k].all / static_cast<double>(looked_at.size())),
                              slides ? "N" : "N m"));
  }
}

void check_torque_columns(const Robot& robot, const Recording& recording,
                          ContactTreatment contacts) {
  const Products sums = products_of(robot, recording, contacts);
  check_scale(robot, sums);
  check_order(robot, sums);
}

}  // namespace shapeid::diagnosis
