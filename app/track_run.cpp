#include "shapeid/app/track_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "shapeid/models/strict_json.hpp"

namespace shapeid::app {
namespace {

using fast::Identifier;
using nlohmann::json;

// Steps of the clock: more than this is a gap, or, backwards, a clock that was set.
constexpr double gap_steps = 5.0;
// More than this and rows were lost.
constexpr double missing_steps = 1.5;
// s: a line is printed after so much time also when there are no samples to make a window of.
constexpr double longest_silence = 0.1;
// rad/s (m/s of a slider), and s: slower for longer is standing still. Far above what noise of
// usual gyros and encoders leaves behind the filter, far below any motion that excites.
constexpr double slow = 0.05;
constexpr double calm_seconds = 0.25;
// Standard errors to either side: 95 percent of a normal distribution.
constexpr double interval = 1.96;

const char* name(fast::Outcome outcome) {
  switch (outcome) {
    case fast::Outcome::solved:
      return "solved";
    case fast::Outcome::not_finite:
      return "rows are not finite";
    case fast::Outcome::ill_conditioned:
      return "ill-conditioned";
    case fast::Outcome::too_many_steps:
      return "too many steps";
    case fast::Outcome::out_of_scale:
      return "forces that no robot has";
  }
  return "";
}

}  // namespace

TrackRun::TrackRun(const LogTable& log, const RobotInputs& robot, const BodyModel& model,
                   TrackSettings settings)
    : robot_(robot),
      model_(model),
      settings_(std::move(settings)),
      meaning_(log, robot.robot, robot.mapping),
      guard_(meaning_.plan(), static_cast<std::size_t>(robot.robot.joint_count())),
      stream_(log.path(), meaning_.plan(), robot.robot, robot.notes.imu, settings_.stream),
      events_(meaning_.plan().channels.size(), robot.robot.contacts.size()),
      repeats_(meaning_.plan(), robot.robot.joint_count()),
      path_(log.path()) {
  check_forces(path_, settings_.estimates.identifier.contacts, meaning_.plan().force >= 0);
}

std::vector<json> TrackRun::push(const LogRow& row) {
  due_.clear();
  if (meaning_.kept(row)) watch_clock(meaning_.read(row));
  return std::exchange(due_, {});
}

/// Rows of the right time go on; rows that come twice or late are left out; a clock that was set
/// back, or forward by far, starts everything but the answers anew.
void TrackRun::watch_clock(MeasuredRow row) {
  ++events_.rows;
  const double time = row.time;
  const double usual = stream_.row_step() > 0.0 ? stream_.row_step() : row_step_.value_or(0.0);
  bool follows = true;
  if (row_time_) {
    const double step = time - *row_time_;
    if (step <= 0.0 && step >= -gap_steps * usual) {
      ++events_.repeated;
      return;
    }
    follows = step > 0.0 && (usual == 0.0 || step <= gap_steps * usual);
    if (step < 0.0) {
      ++events_.clock_back;
    } else if (!follows) {
      ++events_.gaps;
    } else if (usual > 0.0 && step > missing_steps * usual) {
      events_.missing += static_cast<std::size_t>(std::lround(step / usual)) - 1;
    }
    if (!row_step_ && step > 0.0) row_step_ = step;
  }
  if (!follows) {
    guard_.flush();
    while (const std::optional<GuardedRow> held = guard_.next()) take(*held);
    stream_.restart();
    repeats_.restart();
    while (const std::optional<Sample> sample = stream_.next()) take(*sample);
    line_time_.reset();
  }
  row_time_ = time;
  guard_.push(std::move(row));
  while (const std::optional<GuardedRow> passed = guard_.next()) take(*passed);
  if (!line_time_) line_time_ = time;
  if (!estimates_) return;
  constexpr double windows = 1.5;  // a window that is late has had time to come
  const double window = static_cast<double>(settings_.estimates.identifier.window) / stream_.rate();
  // By the clock of the samples, not of the rows: what is still on its way may end a window.
  const double passed = guard_.oldest_held() - stream_.latency();
  if (passed - *line_time_ > std::max(longest_silence, windows * window)) {
    print(Why::no_samples, passed);
  }
}

void TrackRun::take(const GuardedRow& row) {
  events_.add(row.faults);
  repeats_.push(row.row);
  stream_.push(row.row);
  if (stream_.rate() > 0.0 && !estimates_) {
    prepare();
    Plausibility::Options units;  // what stands still or jumps is counted, and left out
    units.longest_step = gap_steps * stream_.row_step();
    units.refuse_frozen = units.refuse_readings = false;
    units_.emplace(path_, robot_.robot, meaning_.plan(), units);
  }
  watch_units(row.row);
  while (const std::optional<Sample> sample = stream_.next()) take(*sample);
  // Where rows make no samples, none asks for them.
  if (estimates_) repeats_.forget_before(row.row.time - stream_.latency());
}

/// A wrong unit is wrong from the beginning. A robot that has run for hours is not stopped for what
/// looks like one.
void TrackRun::watch_units(const MeasuredRow& row) {
  if (!units_) return;
  constexpr std::size_t at_once = 1000, all = 5000;
  units_->add(row);
  if (++rows_of_units_ % at_once == 0) units_->judge();
  if (rows_of_units_ == all) units_.reset();
}

std::string TrackRun::why_no_line() const {
  if (stream_.rate() == 0.0) {
    return fmt::format("no line: no {} rows in the order of time", SampleStream::head_rows);
  }
  const double seconds = static_cast<double>(events_.rows) * stream_.row_step();
  if (stream_.latency() > seconds) {
    return fmt::format(
        "no line: with --cutoff {:g} the first sample comes after {:.3g} s, and the log has "
        "{:.3g} s; give a higher one",
        settings_.stream.cutoff, stream_.latency(), seconds);
  }
  return fmt::format("no line: no window of {} samples", settings_.estimates.identifier.window);
}

bool TrackRun::never_found_mass() const {
  return estimates_ && estimates_->finds_no_mass() && !estimates_->ever_explained();
}

std::optional<double> TrackRun::mass_out_of_scale() const {
  if (!estimates_ || !estimates_->asks_too_much() || was_in_scale_) return std::nullopt;
  return total_mass(estimates_->recent());
}

void TrackRun::prepare() {
  estimates_.emplace(robot_.robot, model_, settings_.estimates, stream_.rate());
  slip_.emplace(robot_.robot, stream_.rate());
}

void TrackRun::take(const Sample& sample) {
  const double period = 1.0 / stream_.rate();
  if (sample_time_) {
    const double step = sample.time - *sample_time_;
    if (step < 0.0 || step > missing_steps * period) {
      estimates_->forget_samples();
      slip_->restart();
      estimates_->pass(std::max(step, 0.0));
      calm_ = held_back_ = 0;
    }
  }
  sample_time_ = sample.time;
  const std::vector<bool>& touching = sample.in_contact;
  if (std::find(touching.begin(), touching.end(), true) == touching.end()) ++events_.airborne;
  for (const int contact : slip_->watch(sample)) {
    ++events_.slipping[static_cast<std::size_t>(contact)];
  }
  if (stands_still(sample)) {
    if (held_back_ == 0) estimates_->forget_samples();
    ++events_.still;
    if (++held_back_ % settings_.estimates.identifier.window != 0) return;
    estimates_->pass(static_cast<double>(settings_.estimates.identifier.window) * period);
    return print(Why::still, sample.time);
  }
  held_back_ = 0;
  const Identifier::Fed fed = estimates_->feed(sample, repeats_.repeats(sample.time));
  if (fed == Identifier::Fed::sample_declined) {
    const bool forces = settings_.estimates.identifier.contacts == ContactTreatment::measured &&
                        sample.contact_force.size() != robot_.robot.contacts.size();
    ++(forces ? events_.no_forces : events_.not_finite);
    return;
  }
  ++events_.taken;
  if (fed == Identifier::Fed::answered) print(Why::answered, sample.time);
  if (fed == Identifier::Fed::window_declined) print(Why::declined, sample.time);
}

bool TrackRun::stands_still(const Sample& sample) {
  const double fastest = std::max(sample.base_angular_velocity.norm(),
                                  sample.dq.size() > 0 ? sample.dq.cwiseAbs().maxCoeff() : 0.0);
  calm_ = fastest < slow ? calm_ + 1 : 0;
  return static_cast<double>(calm_) >= calm_seconds * stream_.rate();
}

void TrackRun::print(Why why, double time) {
  const Identifier& identifier = estimates_->identifier();
  events_.contacts_unknown = stream_.take_unknown_contacts();
  json line = {{"format", "shapeid-track-1"},
               {"line", lines_},
               {"time", time},
               {"group_delay", stream_.group_delay()},
               {"answered", why == Why::answered},
               {"links", links_json()},
               {"mass", mass_json()},
               {"rows", rows_json()},
               {"samples", samples_json()},
               {"contacts", contacts_json()},
               {"why", nullptr},
               {"objective", nullptr},
               {"gap", nullptr},
               {"scale", nullptr},
               {"load", nullptr},
               {"contradicted", estimates_->contradicts_rows()},
               {"doubt", nullptr}};
  // A scale that is wrong may hide from a filter that is slow to follow: it foretells nothing then.
  if (estimates_->asks_too_much()) {
    line["doubt"] = "torque-scale";
  } else if (estimates_->finds_no_mass()) {
    line["doubt"] = "no-mass";
  } else if (why == Why::answered && estimates_->fills_recent()) {
    was_in_scale_ = true;
  }
  switch (why) {
    case Why::answered:
      line["objective"] = identifier.answer().value.total();
      line["gap"] = identifier.answer().gap;
      line["scale"] = scale();
      if (const std::optional<LoadChange>& load = estimates_->load_change()) {
        line["load"] = {{"since", load->since},
                        {"mass", load->mass},
                        {"standard_error", load->standard_error},
                        {"settled", load->settled},
                        {"holds", load->holds}};
      }
      break;
    case Why::still:
      line["why"] = "stands still: nothing is excited";
      break;
    case Why::no_samples:
      line["why"] = events_.contacts_unknown > 0 ? "no samples: contacts are not known"
                                                 : "no samples: see rows";
      break;
    case Why::declined:
      line["why"] = std::string("window declined: ") + name(identifier.outcome());
      break;
  }
  if (why == Why::answered) {
    why_no_answer_.reset();
  } else if (why_no_answer_) {
    why_no_answer_ = line["why"].get<std::string>();
  }
  due_.push_back(std::move(line));
  ++lines_;
  line_time_ = time;
  events_ = TrackEvents(meaning_.plan().channels.size(), robot_.robot.contacts.size());
}

json TrackRun::links_json() const {
  const Identifier& identifier = estimates_->identifier();
  json links = json::array();
  for (std::size_t i = 0; i < model_.free_links.size(); ++i) {
    const auto at = 10 * static_cast<Eigen::Index>(i);
    const auto link = static_cast<std::size_t>(model_.free_links[i]);
    links.push_back({{"name", robot_.robot.links[link].name},
                     {"parameters", vector_json(identifier.Phi().segment<10>(at))},
                     {"filtered", vector_json(identifier.filtered().segment<10>(at))},
                     {"recent", vector_json(estimates_->recent().segment<10>(at))},
                     {"tracked", vector_json(estimates_->tracked().segment<10>(at))}});
  }
  return links;
}

json TrackRun::mass_json() const {
  const double tracked = total_mass(estimates_->tracked());
  // No mass is below zero, whatever the rows say.
  const double rows = std::max(0.0, estimates_->mass_by_rows());
  const double error = interval * estimates_->mass_error();
  // What no row tells, shapes may, which know no error.
  const double beyond = estimates_->rows_tell_mass() ? 0.0 : error;
  return {{"window", total_mass(estimates_->identifier().Phi())},
          {"filtered", total_mass(estimates_->identifier().filtered())},
          {"recent", total_mass(estimates_->recent())},
          {"tracked", tracked},
          {"rows", rows},
          {"interval",
           {std::max(0.0, std::min(tracked - beyond, rows - error)),
            std::max(tracked + beyond, rows + error)}}};
}

json TrackRun::rows_json() const {
  return {{"read", events_.rows},
          {"repeated", events_.repeated},
          {"missing", events_.missing},
          {"clock_back", events_.clock_back},
          {"gaps", events_.gaps},
          {"outliers", by_channel(events_.outliers, meaning_.plan())},
          {"stuck", by_channel(events_.stuck, meaning_.plan())},
          {"saturated", by_channel(events_.saturated, meaning_.plan())}};
}

json TrackRun::samples_json() const {
  return {{"taken", events_.taken},
          {"still", events_.still},
          {"not_finite", events_.not_finite},
          {"no_forces", events_.no_forces},
          {"contacts_unknown", events_.contacts_unknown}};
}

json TrackRun::contacts_json() const {
  json slipping = json::array();
  for (std::size_t c = 0; c < events_.slipping.size(); ++c) {
    if (events_.slipping[c] > 0) slipping.push_back(robot_.robot.contacts[c].name);
  }
  return {{"airborne", events_.airborne}, {"slipping", slipping}};
}

/// What tells kilograms from multiples of them: torques of joints, or forces, or links that are
/// known. Base rows alone, with nothing to push against, fix ratios of masses only.
std::string TrackRun::scale() const {
  const Robot& robot = robot_.robot;
  if (settings_.estimates.identifier.contacts == ContactTreatment::measured) return "forces";
  const bool all_in_air = events_.airborne == events_.taken + events_.still + events_.not_finite;
  const bool joint_carries = model_.free_links.back() > 0;
  if (robot.root == Root::fixed || joint_carries || !all_in_air) return "joint rows";
  for (int i = 0; i < robot.link_count(); ++i) {
    if (model_.known[Eigen::Index{10} * i] > 0.0) return "known links";
  }
  return "nothing";
}

}  // namespace shapeid::app
