#include "shapeid/diagnosis/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/joint_zeros.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/motion_extent.hpp"
#include "shapeid/reference/contact.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr std::size_t seen_samples = 2000;  // of a log, evenly: enough for these coarse questions

std::size_t stride_for(const Recording& recording) {
  return std::max<std::size_t>(1, recording.samples().size() / seen_samples);
}

void check_excitation(const Robot& robot, const Recording& recording) {
  MotionExtent extent;
  for (const Sample& s : recording.samples()) extent.add(s);
  if (extent.some_joint_moved(robot)) return;
  throw Refusal("not-excited", "no joint moves; log a motion that moves and loads every joint");
}

/// What feet push against each other is left out on a floating base: it is known from torque, and
/// would follow that at any scale.
Eigen::VectorXd load_without_torque(const Viewer& viewer, const View& view,
                                    const RichModel& given) {
  if (viewer.robot().root == Root::fixed) return predict(viewer, view, given).load.joint;
  const Eigen::VectorXd carried = view.Y * given.Phi - view.carried;
  const Eigen::VectorXd f = carrying_forces(viewer.robot(), carried, view.J);
  return (carried - view.J.transpose() * f).tail(viewer.robot().joint_count());
}

void check_torque_scale(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  const RichModel given{stacked_parameters(robot), {}};
  const Viewer viewer(robot, contacts, {});
  const Eigen::Index n = robot.joint_count();
  Eigen::VectorXd pp = Eigen::VectorXd::Zero(n), pt = pp, tt = pp;
  for (const std::size_t i : recording.usable(stride_for(recording))) {
    const View view = viewer.view(recording, i);
    const Eigen::VectorXd load = load_without_torque(viewer, view, given);
    pp += load.cwiseAbs2();
    pt += load.cwiseProduct(view.sample.tau);
    tt += view.sample.tau.cwiseAbs2();
  }
  // Joints whose torque the given model follows closely tell the scale; friction and errors of
  // inertia do not make a factor of four at all of them.
  constexpr double close = 0.8, far = 4.0;
  int telling = 0, against = 0, above = 0, below = 0;
  double typical = 0.0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const double correlation = pt[j] / std::sqrt(std::max(pp[j] * tt[j], 1e-300));
    if (!(std::abs(correlation) > close)) continue;
    const double scale = pt[j] / pp[j];
    ++telling;
    if (scale < 0.0) {
      ++against;
      continue;
    }
    if (scale > far) ++above;
    if (scale < 1.0 / far) ++below;
    typical += std::log(scale);
  }
  if (telling == 0) return;
  if (against == telling) {
    throw Refusal("torque-sign",
                  fmt::format("the logged torque runs against the given model at {} joints, and "
                              "with it at none: turn it in the mapping (sign: -1){}",
                              telling,
                              robot.root == Root::fixed
                                  ? ", or the base in the URDF, if it hangs upside down, or a "
                                    "joint's zero, if it is half a turn off"
                                  : ""));
  }
  if (above == telling || below == telling) {
    throw Refusal(
        "torque-scale",
        fmt::format("the logged torque follows the given model at {} joints, but is {:.2g} "
                    "times as large: a current or the motor's torque; declare it in the "
                    "mapping (torque: kind, factor)",
                    telling, std::exp(typical / telling)));
  }
}

/// Where motion is fast, torque need not run against the model of a base that hangs.
void check_base(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  if (robot.root != Root::fixed) return;
  const auto squared_error = [&](const std::vector<AppliedEffect>& effects) {
    const RichModel model{stacked_parameters(robot), effects};
    return series(robot, contacts, model, recording, stride_for(recording)).residual.squaredNorm();
  };
  AppliedEffect half_turn = at_start(*find_effect("gravity_tilt"), 0);
  half_turn.value[0] = std::numbers::pi;
  if (!(squared_error({half_turn}) < far_better * squared_error({}))) return;
  throw Refusal("upside-down",
                "the given model predicts the logged torque far better with its base upside down: "
                "turn the base in the URDF, or the torque in the mapping (sign: -1)");
}

void check_contact_labels(const Robot& robot, const Recording& recording) {
  // Speed of declared stance feet against their mean, and of the feet in the air against the same.
  double stance = 0.0, swing = 0.0;
  std::size_t stance_count = 0, swing_count = 0;
  for (const std::size_t i : recording.usable(stride_for(recording))) {
    const Sample& s = recording[i];
    const Eigen::Matrix3Xd v = reference::contact_velocities(robot, s);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    int standing = 0;
    for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
      if (!s.in_contact[c]) continue;
      mean += v.col(static_cast<Eigen::Index>(c));
      ++standing;
    }
    if (standing < 2) continue;
    mean /= standing;
    for (std::size_t c = 0; c < s.in_contact.size(); ++c) {
      const double speed = (v.col(static_cast<Eigen::Index>(c)) - mean).squaredNorm();
      (s.in_contact[c] ? stance : swing) += speed;
      ++(s.in_contact[c] ? stance_count : swing_count);
    }
  }
  constexpr std::size_t enough = 50;
  if (stance_count < enough || swing_count < enough) return;
  const double standing = std::sqrt(stance / static_cast<double>(stance_count));
  const double flying = std::sqrt(swing / static_cast<double>(swing_count));
  constexpr double alike = 0.7;  // standing feet of a trot move at a fifth of those in the air
  if (standing > alike * flying) {
    throw Refusal("contact-labels",
                  fmt::format("feet declared to stand move against each other at {:.2g} m/s, feet "
                              "declared in the air at {:.2g} m/s: the labels do not fit the motion",
                              standing, flying));
  }
}

/// Of one log.
void check_clock(Tally tally, const RichModel& given, const LoopSettings& settings) {
  const Eigen::Index column = tally.inertial;
  const std::size_t half = tally.blocks.size() / 2;
  if (half < 4) return;
  const BlockFits fits(std::move(tally), given.Phi, settings.size, 4);
  const Term whole{"delay", {column}, {false}, 0};
  const Term later{"drift", {column}, {false}, half};
  const Fit fit = fits.fit({term_of_masses(settings.shapes.free_links), whole, later});
  const Eigen::Index last = fit.value.size() - 1;
  constexpr double least_drift = 5e-3;  // s; less is a delay that depends on the motion
  constexpr double least_z = 6.0;
  const double drift = fit.value[last];
  if (std::abs(drift) > least_drift && std::abs(drift) > least_z * fit.standard_error[last]) {
    throw Refusal("clock-skew",
                  fmt::format("torque is {:.1f} ms late in the log's first half and {:.1f} ms in "
                              "its second: the clocks of torque and joints drift apart",
                              1e3 * fit.value[last - 1], 1e3 * (fit.value[last - 1] + drift)));
  }
}

}  // namespace

void check_recording(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  if (recording.samples().empty()) throw Refusal("no-data", "the log has no usable sample");
  check_excitation(robot, recording);
  check_meaning(robot, recording, contacts);
}

void check_meaning(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  check_torque_scale(robot, recording, contacts);
  check_base(robot, recording, contacts);
  check_joint_zeros(robot, recording, contacts);
  if (contacts == ContactTreatment::project) check_contact_labels(robot, recording);
}

void check_clocks(const Robot& robot, const Recording& recording, const LoopSettings& settings,
                  const std::vector<std::size_t>& log_starts) {
  const std::vector<AppliedEffect> delay = {at_start(*find_effect("torque_delay"), 0)};
  const Tally nothing = empty_tally(robot, delay);
  Tally all = nothing;
  TallyOptions options;
  options.stride = settings.stride;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  options.log_starts = log_starts;
  constexpr double blocks = 40.0;
  options.block_seconds =
      recording.duration() / (blocks * static_cast<double>(log_starts.size() + 1));
  const RichModel given{stacked_parameters(robot), {}};
  add_to_tally(all, robot, settings.rows, given, recording, options, false);
  // Each log by itself: clocks that were set anew between two logs do not drift.
  for (std::size_t log = 0; log <= log_starts.size(); ++log) {
    Tally own = nothing;
    std::ranges::copy_if(all.blocks, std::back_inserter(own.blocks),
                         [log](const Block& block) { return block.log == log; });
    check_clock(std::move(own), given, settings);
  }
}

}  // namespace shapeid::diagnosis
