#include "shapeid/diagnosis/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "shapeid/diagnosis/accelerometer_axes.hpp"
#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/joint_readings.hpp"
#include "shapeid/diagnosis/leg_order.hpp"
#include "shapeid/diagnosis/quarter_turns.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/torque_columns.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/motion_extent.hpp"
#include "shapeid/models/student.hpp"
#include "shapeid/reference/carrying_feet.hpp"
#include "shapeid/reference/standing_feet.hpp"

namespace shapeid::diagnosis {
namespace {

/// Where motion is fast, torque need not run against the model of a base that hangs.
void check_base(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  if (robot.root != Root::fixed) return;
  const auto squared_error = [&](const std::vector<AppliedEffect>& effects) {
    const RichModel model{stacked_parameters(robot), effects};
    return series(robot, contacts, model, recording, recording.stride_of(2000))
        .residual.squaredNorm();
  };
  AppliedEffect half_turn = at_start(*find_effect("gravity_tilt"), 0);
  half_turn.value[0] = std::numbers::pi;
  if (!(squared_error({half_turn}) < far_better * squared_error({}))) return;
  throw Refusal("upside-down",
                "the given model predicts the logged torque far better with its base upside down: "
                "turn the base in the URDF, or the torque in the mapping (sign: -1)");
}

void check_standing_feet(const Robot& robot, const Recording& recording) {
  reference::StandingFeet feet(robot);
  for (const std::size_t i : recording.usable(recording.stride_of(2000))) feet.add(recording[i]);
  feet.judge();
}

void check_carrying_feet(const Robot& robot, const Recording& recording) {
  reference::CarryingFeet feet(robot);
  for (const Sample& sample : recording.samples()) feet.add(sample);
  feet.judge();
}

/// Of one log.
void check_clock(Tally tally, const RichModel& given, const LoopSettings& settings,
                 const std::string& name) {
  const Eigen::Index column = tally.inertial;
  const Eigen::Index count = std::ssize(tally.blocks);
  const std::size_t half = tally.blocks.size() / 2;
  if (half < 4) return;
  const BlockFits fits(std::move(tally), given.Phi, settings.size, 4);
  const Term whole{"delay", {column}, {false}, 0};
  const Term later{"drift", {column}, {false}, half};
  const Fit fit = fits.fit({term_of_masses(settings.shapes.free_links), whole, later});
  const Eigen::Index last = fit.value.size() - 1;
  constexpr double least_drift = 5e-3;  // s; less is a delay that depends on the motion
  const double least_t = limit_for(6.0, count);
  const double drift = fit.value[last];
  if (std::abs(drift) > least_drift && std::abs(drift) > least_t * fit.standard_error[last]) {
    throw Refusal("clock-skew",
                  fmt::format("{}{}torque is {:.1f} ms late in the log's first half and {:.1f} ms "
                              "in its second: the clocks of torque and joints drift apart, or rows "
                              "were held, lost or repeated",
                              name, name.empty() ? "" : ": ", 1e3 * fit.value[last - 1],
                              1e3 * (fit.value[last - 1] + drift)));
  }
}

}  // namespace

void check_excitation(const Robot& robot, const Recording& recording) {
  if (recording.samples().empty()) throw Refusal("no-data", "the log has no usable sample");
  MotionExtent extent;
  for (const Sample& s : recording.samples()) extent.add(s);
  if (extent.some_joint_moved(robot)) return;
  throw Refusal("not-excited", "no joint moves; log a motion that moves and loads every joint");
}

void check_meaning(const Robot& robot, const Recording& recording, ContactTreatment contacts) {
  check_silent_torques(robot, recording, contacts);
  // Legs that are exchanged have contacts at odds with their feet as well.
  check_leg_order(robot, recording, contacts);
  // Then what needs no inertia.
  if (contacts == ContactTreatment::project) check_standing_feet(robot, recording);
  check_torque_columns(robot, recording, contacts);
  if (contacts == ContactTreatment::project) check_carrying_feet(robot, recording);
  check_accelerometer(robot, recording, contacts);
  check_base(robot, recording, contacts);
  check_joint_readings(robot, recording, contacts);
}

void check_clocks(const Robot& robot, const Recording& recording, const LoopSettings& settings,
                  const std::vector<std::size_t>& log_starts,
                  const std::vector<std::string>& names) {
  const std::vector<AppliedEffect> delay = {at_start(*find_effect("torque_delay"), 0)};
  const Tally nothing = empty_tally(robot, delay);
  Tally all = nothing;
  TallyOptions options;
  options.stride = settings.stride;
  options.threads = settings.threads;
  options.weight = Eigen::VectorXd::Ones(robot.dof());
  options.log_starts = log_starts;
  constexpr double blocks = 40.0;
  options.block_seconds = std::max(
      shortest_block, recording.duration() / (blocks * static_cast<double>(log_starts.size() + 1)));
  const RichModel given{stacked_parameters(robot), {}};
  add_to_tally(all, robot, settings.rows, given, recording, options, false);
  // A log without samples begins nowhere, and leaves open which are the others.
  const bool is_named = names.size() == log_starts.size() + 1;
  // Each log by itself: clocks that were set anew between two logs do not drift.
  for (std::size_t log = 0; log <= log_starts.size(); ++log) {
    Tally own = nothing;
    std::ranges::copy_if(all.blocks, std::back_inserter(own.blocks),
                         [log](const Block& block) { return block.log == log; });
    check_clock(std::move(own), given, settings, is_named ? names[log] : "");
  }
}

}  // namespace shapeid::diagnosis
