#include "shapeid/models/motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/contact_margin.hpp"
#include "shapeid/models/equal_signals.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/held_positions.hpp"
#include "shapeid/models/held_torques.hpp"
#include "shapeid/models/plausibility.hpp"
#include "shapeid/models/resampler.hpp"
#include "shapeid/models/row_steps.hpp"
#include "shapeid/models/sample_builder.hpp"
#include "shapeid/models/saturations.hpp"
#include "shapeid/models/segment_samples.hpp"
#include "shapeid/models/stretches.hpp"

namespace shapeid {
namespace {

// Rows from which the median steps are taken. A stream must not wait for as many.
constexpr std::size_t head_of_log = 4096;
constexpr std::size_t head_of_stream = 256;

void check_exact(const ChannelPlan& plan, const std::string& path) {
  if (plan.dq < 0 || plan.ddq < 0 || (plan.floating() && plan.gyrodot < 0)) {
    throw InputError({path}, "lacks derivatives",
                     plan.floating() ? "exact derivatives need dq.*, ddq.* and base.gyrodot.*"
                                     : "exact derivatives need dq.* and ddq.*");
  }
}

Margin margin_around(const MotionOptions& options) {
  if (options.exact_derivatives) return {};
  if (options.contact_margin) return {*options.contact_margin, *options.contact_margin};
  return margin_of(options.smoothing, options.cutoff);
}

}  // namespace

struct MotionReader::State {
  State(const std::string& path, const Robot& r, const RobotNotes& notes,
        const std::optional<Mapping>& mapping, const MotionOptions& o)
      : robot(r),
        imu(notes.imu),
        options(o),
        source(path, r, mapping),
        equal(source.plan(), r.joint_count()),
        repeated(source.plan(), r.joint_count()),
        held(source.plan(), r.joint_count()),
        held_torques(source.plan(), r),
        saturations(source.plan(), r.joint_count()),
        margin(o.at_contact_change, margin_around(o)) {
    const ChannelPlan& plan = source.plan();
    if (options.contact_margin && !(*options.contact_margin >= 0.0)) {
      throw InputError(
          fmt::format("a margin of {:g} s around a contact's change", *options.contact_margin),
          "0 or more");
    }
    if (options.exact_derivatives) check_exact(plan, path);
    if (options.use_logged_velocity && plan.dq < 0) {
      throw InputError({path}, "has no dq.* columns", "log them, or do not ask to use them");
    }
    report.contacts_logged = !plan.contacts.empty();
    report.contacts_derived =
        !robot.contacts.empty() && plan.contacts.empty() && options.derive_contacts != nullptr;
    if (options.contacts_needed && !robot.contacts.empty() && !report.contacts_logged &&
        !report.contacts_derived) {
      throw InputError({path}, "has no contact.* columns, but the robot has contacts",
                       "log a flag for each (0 in the air), or have them derived");
    }
    report.floating = plan.floating();
    report.forces_logged = plan.force >= 0;
    report.extra = plan.extra;
    if (report.contacts_derived) {
      report.notes.push_back(fmt::format(
          "no contact.* columns: which feet touch is derived from joint torques and the given "
          "masses ({})",
          options.names.derive_contacts));
    }
    if (plan.dq < 0) {
      report.notes.emplace_back("no dq.* columns: units of q and time are not checked by slopes");
    }
    if (options.smoothing == Smoothing::none && !options.exact_derivatives) {
      report.notes.emplace_back(
          "nothing is smoothed: accelerations are differences of readings, with all their noise");
    }
    read_head();
  }

  const Robot& robot;
  Eigen::Isometry3d imu;
  MotionOptions options;
  MotionReport report;
  MeasuredRows source;
  std::deque<MeasuredRow> head;
  std::optional<Plausibility> plausibility;
  EqualSignals equal;
  RepeatedStretches repeated;
  HeldPositions held;
  HeldTorques held_torques;
  Saturations saturations;
  std::optional<Resampler> grid;
  std::optional<SegmentSamples> segments;
  ContactMargin margin;
  bool ended = false;

  void read_head() {
    const std::size_t wanted =
        options.smoothing == Smoothing::causal ? head_of_stream : head_of_log;
    while (head.size() < wanted) {
      std::optional<MeasuredRow> row = source.next();
      if (!row) break;
      head.push_back(std::move(*row));
    }
    const double row_step = median_row_step(head);
    if (options.exact_derivatives) {
      report.rate = row_step > 0.0 ? 1.0 / row_step : 0.0;
      if (head.size() > 1) judge_head(row_step);
    } else {
      prepare(row_step);
    }
  }

  void judge_head(double row_step) {
    plausibility.emplace(
        source.path(), robot, source.plan(),
        Plausibility::Options{gap_steps * row_step, options.expect_gravity, options.refuse_frozen,
                              true, options.exact_derivatives});
    for (const MeasuredRow& row : head) plausibility->add(row);
    plausibility->judge();
  }

  /// Sets up all that stands between measured rows and samples.
  void prepare(double row_step) {
    if (head.size() < 2) {
      std::string wrong = fmt::format("has {} rows of measurements", head.size());
      if (source.filtered() > 0) {
        wrong += fmt::format(", and {} that the mapping's keep_rows leaves out", source.filtered());
      }
      throw InputError({source.path()}, wrong, "a motion takes at least some tenths of a second");
    }
    check_clock(source.path(), source.plan().time.from, row_step);
    judge_head(row_step);
    const Eigen::VectorXd steps = median_steps(head, source.plan(), source.path());
    const double logged_rate = 1.0 / row_step;
    report.rate = options.rate > 0.0 ? options.rate : logged_rate;
    check_grid(options.names.rate, report.rate, logged_rate);
    constexpr double of_any_rate = 0.25;
    const bool filters = options.smoothing != Smoothing::none;
    if (filters) check_cutoff(options.names.cutoff, options.cutoff, report.rate);
    const double cutoff = filters ? options.cutoff : of_any_rate * report.rate;  // of no effect
    const Butterworth design(options.order, cutoff, report.rate);
    if (options.smoothing == Smoothing::causal) report.group_delay = design.group_delay(0.0);
    grid.emplace(report.rate, gap_steps * steps.cwiseMax(row_step));
    segments.emplace(
        source.plan(), robot, imu, design,
        SegmentSamples::Options{options.smoothing, report.rate, options.use_logged_velocity});
  }

  std::optional<MeasuredRow> next_row() {
    if (!head.empty()) {
      MeasuredRow row = std::move(head.front());
      head.pop_front();
      return row;
    }
    std::optional<MeasuredRow> row = source.next();
    if (row && plausibility) plausibility->add(*row);
    return row;
  }

  /// Lets one more row of the log in; false at its end.
  bool advance() {
    if (ended) return false;
    const std::optional<MeasuredRow> row = next_row();
    if (row) equal.add(*row);
    if (row) repeated.add(*row);
    if (row) held.add(*row);
    if (row) held_torques.add(*row);
    if (row) saturations.add(*row);
    if (options.exact_derivatives) {
      if (row) take_exact(*row);
    } else {
      row ? grid->push(*row) : grid->finish();
      while (const std::optional<GridRow> point = grid->next()) segments->push(*point);
      if (!row) segments->finish();
      while (std::optional<FlaggedSample> sample = segments->next()) take(std::move(*sample));
    }
    if (!row) end_log();
    return true;
  }

  void take_exact(const MeasuredRow& row) {
    if (row.values.hasNaN()) {
      throw InputError({source.path(), row.line}, "has an empty field",
                       "exact derivatives need every value in every row");
    }
    take({make_exact_sample(source.plan(), robot, imu, row), row.contacts, false});
  }

  void take(FlaggedSample sample) {
    if (report.contacts_derived) {
      const std::optional<std::vector<bool>> derived = options.derive_contacts(sample.sample);
      sample.contacts.assign(robot.contacts.size(), -1);
      if (derived) sample.contacts.assign(derived->begin(), derived->end());
    }
    margin.push(std::move(sample));
  }

  /// What is not refused: two drives that share a load equally, and a simulation that goes round
  /// and round, read like this, too.
  void note_copies() {
    for (const auto& [one, other] : equal.found()) {
      report.notes.push_back(fmt::format(
          "columns {} and {} say the same in every row: is one a copy of the other?", one, other));
    }
    constexpr double percent = 100.0;
    if (!(repeated.share() > StretchCounts::too_many)) return;
    report.notes.push_back(fmt::format(
        "{:.0f} percent of the motion stand in the log a second time: standard errors are too "
        "small, and what is held out may be a copy of what is fitted",
        percent * repeated.share()));
  }

  [[nodiscard]] const std::string& column(int channel) const {
    return source.plan().channels[static_cast<std::size_t>(channel)].from;
  }
  [[nodiscard]] const char* unit_of_position(int joint) const {
    return robot.joint(joint).kind == JointKind::prismatic ? "m" : "rad";
  }
  [[nodiscard]] static std::string times(std::size_t count) {
    return count > 1 ? fmt::format(" ({} times)", count) : "";
  }

  void note_held() {
    std::size_t count = 0;
    const std::optional<HeldPosition> longest = held.longest(count);
    if (!longest) return;
    report.notes.push_back(fmt::format(
        "{}:{}: {} stays the same for {:.2g} s and then jumps by {:.2g} {}: readings were held{}; "
        "leave these rows out, a gap is no harm",
        source.path(), longest->line, column(source.plan().q + longest->joint), longest->seconds,
        longest->jump, unit_of_position(longest->joint), times(count)));
  }

  void note_held_torques() {
    for (const int joint : held_torques.silent()) {
      report.notes.push_back(
          fmt::format("{} is zero in every row while {} moves: taken for a joint that nothing "
                      "drives",
                      column(source.plan().tau + joint), robot.joint(joint).name));
    }
    std::size_t count = 0;
    const std::optional<HeldTorque> longest = held_torques.longest(count);
    if (!longest) return;
    report.notes.push_back(fmt::format(
        "{}:{}: {} stays at {:.3g} for {:.2g} s while the joint moves by {:.2g} {}{}: leave these "
        "rows out if readings were held or lost, a gap is no harm",
        source.path(), longest->line, column(source.plan().tau + longest->joint), longest->torque,
        longest->seconds, longest->way, unit_of_position(longest->joint), times(count)));
  }

  void note_saturations() {
    constexpr double percent = 100.0;
    for (const Saturation& s : saturations.found()) {
      report.notes.push_back(fmt::format(
          "{} comes back to {:.4g} and stays there, in {:.2g} percent of the rows, and is never "
          "beyond: is it saturated?",
          column(s.channel), s.value, percent * s.share));
    }
  }

  void end_log() {
    ended = true;
    if (plausibility) plausibility->judge();
    margin.finish();
    report.rows = source.rows();
    report.dropped_rows = source.filtered();
    report.dropped_at_contacts = margin.dropped();
    note_copies();
    note_held();
    note_held_torques();
    note_saturations();
    if (!segments) return;
    report.gaps = std::max<std::size_t>(segments->segments(), 1) - 1;
    report.dropped_at_ends = segments->lost();
  }
};

MotionReader::MotionReader(const std::string& path, const Robot& robot, const RobotNotes& notes,
                           const std::optional<Mapping>& mapping, const MotionOptions& options)
    : state_(std::make_unique<State>(path, robot, notes, mapping, options)) {}
MotionReader::~MotionReader() = default;
MotionReader::MotionReader(MotionReader&&) noexcept = default;
MotionReader& MotionReader::operator=(MotionReader&&) noexcept = default;

std::optional<Sample> MotionReader::next() {
  do {
    if (std::optional<Sample> sample = state_->margin.next()) {
      ++state_->report.samples;
      return sample;
    }
  } while (state_->advance());
  return std::nullopt;
}

const MotionReport& MotionReader::report() const { return state_->report; }

void add_default_contacts(Robot& robot, const LogTable& log,
                          const std::optional<Mapping>& mapping) {
  if (!robot.contacts.empty()) return;
  for (const std::string& name : contact_names(log, mapping)) {
    const std::optional<int> link = robot.find_link(name);
    if (!link) {
      throw InputError(place_of_column("contact." + name, log, mapping),
                       "the robot has no link of this name", "name links of the URDF");
    }
    const std::vector<Member>& members = robot.links[static_cast<std::size_t>(*link)].members;
    const auto member = std::find_if(members.begin(), members.end(),
                                     [&](const Member& m) { return m.name == name; });
    const Eigen::Isometry3d frame =
        member == members.end() ? Eigen::Isometry3d::Identity() : member->pose;
    robot.contacts.push_back({name, *link, ContactKind::point, frame});
  }
}

void add_default_contacts(Robot& robot, const std::string& log_path,
                          const std::optional<Mapping>& mapping) {
  if (robot.contacts.empty()) add_default_contacts(robot, LogReader(log_path).table(), mapping);
}

}  // namespace shapeid
