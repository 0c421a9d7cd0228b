#include "shapeid/models/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "shapeid/models/motion_extent.hpp"
#include "shapeid/models/row_steps.hpp"

namespace shapeid {
namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double gravity = 9.81;

constexpr std::size_t block = 4096;  // rows, some seconds of any log
// Some dozens of stationary seconds would do; fewer rows leave a stride's impacts in the mean.
constexpr std::size_t enough_rows = 400;
// No joint passes its stop by more than this (URDF limits are often drawn too tight).
constexpr double past_limit = 2.0;
// Eight turns: no limited joint makes them.
constexpr double many_turns = 50.0;
// Rows to a span of the slope test: differences over it are large against quantisation.
constexpr int span = 16;
// Below this correlation q and dq differ by more than a factor, and the test says nothing.
constexpr double correlated = 0.9;
// Noise and late velocities shrink a slope by less than 1 - correlated^2; units by at least 57.
constexpr double slope_slack = 0.25;

bool near(double value, double wanted) { return std::abs(value / wanted - 1.0) <= slope_slack; }

}  // namespace

void check_clock(const std::string& path, const std::string& column, double median_step) {
  constexpr double longest = 0.2, shortest = 1e-6;
  if (median_step < longest && median_step > shortest) return;
  std::string right = "give seconds, and at least five rows a second";
  // 5 Hz to 20 kHz, as a clock counts them
  if (median_step >= longest) right += "; milliseconds take scale: 0.001, microseconds 1e-6";
  throw InputError({path, 0, column}, fmt::format("the median step is {:g} s", median_step), right);
}

void check_grid(std::string_view option, double grid_rate, double logged_rate) {
  constexpr double slack = 0.99;  // a median of jittered stamps
  if (grid_rate >= slack * logged_rate) return;
  throw InputError(fmt::format("{} {:g}: a grid of {:g} Hz for a log of {:g} Hz", option, grid_rate,
                               grid_rate, logged_rate),
                   "leave the log's rate: picking rows would fold noise into the motion");
}

void Plausibility::Range::add(double value, int at) {
  if (std::isnan(value)) return;
  if (std::abs(value) > std::max(std::abs(least), std::abs(most)) || least > most) line = at;
  ValueRange::add(value);
}

std::optional<Plausibility::Span> Plausibility::Slope::add(double t, double position,
                                                           double velocity, double longest_step) {
  if (std::isnan(position) || std::isnan(velocity)) return std::nullopt;
  const bool follows = in_span > 0 && t > time && t - time <= longest_step;
  if (follows) integral += 0.5 * (velocity + dq) * (t - time);
  std::optional<Span> ended;
  if (follows && in_span == span) {
    ended = {position - start, integral, t - began};
    spans.push_back(*ended);
    changes += ended->change * ended->change;
    integrals += ended->integral * ended->integral;
  }
  if (!follows || ended) {
    in_span = 0;
    start = position;
    began = t;
    integral = 0.0;
  }
  ++in_span;
  time = t;
  dq = velocity;
  return ended;
}

Plausibility::Plausibility(std::string path, const Robot& robot, const ChannelPlan& plan,
                           Options options)
    : path_(std::move(path)),
      robot_(robot),
      plan_(plan),
      options_(options),
      ranges_(plan.channels.size()),
      slopes_(static_cast<std::size_t>(robot.joint_count())),
      products_(Eigen::MatrixXd::Zero(robot.joint_count(), robot.joint_count())),
      steps_(slopes_.size()) {
  row_steps_.reserve(block);
}

Place Plausibility::place(int channel, int line) const {
  return {path_, line, plan_.channels[static_cast<std::size_t>(channel)].from};
}

void Plausibility::add(const MeasuredRow& row) {
  for (std::size_t c = 0; c < ranges_.size(); ++c) {
    ranges_[c].add(row.values[static_cast<Eigen::Index>(c)], row.line);
  }
  if (plan_.dq >= 0) add_slopes(row);
  for (int j = 0; options_.refuse_readings && j < robot_.joint_count(); ++j) add_step(j, row);
  if (plan_.floating()) add_gravity(row);
  if (rows_ == 0) {
    first_line_ = row.line;
  } else {
    row_steps_.push_back(row.time - last_time_);
  }
  last_time_ = row.time;
  if (++rows_ == block) judge();
}

void Plausibility::add_slopes(const MeasuredRow& row) {
  // Nothing of a joint whose span goes on.
  Eigen::VectorXd change = Eigen::VectorXd::Zero(robot_.joint_count());
  Eigen::RowVectorXd integral = Eigen::RowVectorXd::Zero(robot_.joint_count());
  bool any = false;
  for (int j = 0; j < robot_.joint_count(); ++j) {
    const auto ended = slopes_[static_cast<std::size_t>(j)].add(
        row.time, row.values[plan_.q + j], row.values[plan_.dq + j], options_.longest_step);
    if (!ended) continue;
    any = true;
    change[j] = ended->change;
    integral[j] = ended->integral;
  }
  if (any) products_.noalias() += change * integral;
}

/// What one reading of many does to a motion that is differentiated twice no sum of squares
/// forgives.
void Plausibility::add_step(int j, const MeasuredRow& row) {
  // No joint goes as far and comes back from row to row: rad/s and rad, or m/s and m.
  const bool slides = robot_.joint(j).kind == JointKind::prismatic;
  const double fastest = slides ? 10.0 : 100.0, far = slides ? 0.05 : 0.5;
  constexpr double turn = 2.0 * std::numbers::pi, slow = 1.0;  // rad
  const double position = row.values[plan_.q + j];
  if (std::isnan(position)) return;
  Steps& s = steps_[static_cast<std::size_t>(j)];
  const double elapsed = row.time - s.time;
  const bool follows = s.rows > 0 && elapsed <= options_.longest_step;
  const double step = follows ? position - s.position : 0.0;
  if (s.rows > 1 && follows && !slides && std::abs(std::abs(step) - turn) < slow &&
      std::abs(s.last) < slow) {
    throw InputError(
        place(plan_.q + j, row.line),
        fmt::format("jumps by {:.3g} rad from one row to the next: an angle that wraps", step),
        "count its turns on (unwrap it)");
  }
  const double out = std::max(far, fastest * elapsed);
  constexpr double little = 0.1;  // beside what a wild reading is off
  const bool jumped = s.rows > 2 && follows && std::abs(s.last) > out &&
                      std::abs(s.before) < little * std::abs(s.last);
  if (jumped && std::abs(step) > out && std::abs(s.last + step) < little * std::abs(step)) {
    throw InputError(place(plan_.q + j, s.line),
                     fmt::format("is {:g} for one row, between {:g} and {:g}: a wild reading",
                                 s.position, s.position - s.last, position),
                     "leave the row out; a gap is no harm");
  }
  // (Readings that were held before it are noted, and where.)
  if (jumped && s.before != 0.0 && std::abs(step) < little * std::abs(s.last)) {
    throw InputError(place(plan_.q + j, s.line),
                     fmt::format("jumps by {:.3g} from one row to the next, and stays there: no "
                                 "joint is as fast",
                                 s.last),
                     "count an encoder's slips on, and leave wild rows out; a gap is no harm");
  }
  s = {row.time, position, step, s.last, row.line, follows ? s.rows + 1 : 1};
}

/// Only while something carries the robot: in flight an accelerometer reads nothing.
void Plausibility::add_gravity(const MeasuredRow& row) {
  const double force = row.values.segment<3>(plan_.accel).norm();
  const bool carried = row.contacts.empty() ||
                       std::find(row.contacts.begin(), row.contacts.end(), 1) != row.contacts.end();
  if (std::isnan(force) || !carried) return;
  force_sum_ += force;
  ++force_count_;
}

/// Nothing that is measured on a robot is larger by orders of magnitude. Sums of squares of what is
/// would not be numbers any more.
void Plausibility::judge_size() const {
  constexpr double most_torque = 1e6, most_speed = 1e5, most_turn = 1e3, most_specific = 1e5;
  const auto judge_channels = [&](int first, int count, double most, const char* unit) {
    for (int channel = first; first >= 0 && channel < first + count; ++channel) {
      const Range& r = range(channel);
      if (r.least > r.most || std::max(-r.least, r.most) <= most) continue;
      throw InputError(
          place(channel, r.line),
          fmt::format("{:g} is no reading of a robot", r.most > -r.least ? r.most : r.least),
          fmt::format("{}, at most {:g}", unit, most));
    }
  };
  constexpr double most_place = 1e6, most_rate = 1e8;
  judge_channels(plan_.q, robot_.joint_count(), most_place, "rad or m");
  judge_channels(plan_.ddq, robot_.joint_count(), most_rate, "rad/s^2 or m/s^2");
  judge_channels(plan_.gyrodot, 3, most_rate, "rad/s^2");
  judge_channels(plan_.tau, robot_.joint_count(), most_torque, "N m or N");
  judge_channels(plan_.dq, robot_.joint_count(), most_speed, "rad/s or m/s");
  constexpr double most_force = 1e6;
  judge_channels(plan_.force, 3 * static_cast<int>(robot_.contacts.size()), most_force, "N");
  if (!plan_.floating()) return;
  judge_channels(plan_.gyro, 3, most_turn, "rad/s");
  judge_channels(plan_.accel, 3, most_specific, "m/s^2");
}

void Plausibility::judge() {
  if (options_.refuse_readings) judge_size();
  for (int j = 0; j < robot_.joint_count(); ++j) {
    judge_slope(j);
    if (robot_.joint(j).kind == JointKind::prismatic) {
      judge_length(j);
    } else {
      judge_angle(j);
    }
  }
  if (options_.expect_gravity) judge_gravity();
  if (options_.refuse_frozen) judge_frozen();
  if (options_.refuse_readings && !options_.exact) judge_rate();
  row_steps_.clear();
  rows_ = force_count_ = 0;
  force_sum_ = 0.0;
  ranges_.assign(ranges_.size(), {});
  slopes_.assign(slopes_.size(), {});
  products_.setZero();
}

void Plausibility::judge_length(int j) const {
  const Joint& joint = robot_.joint(j);
  const Range& q = range(plan_.q + j);
  const double room = joint.upper - joint.lower;
  if (q.least > q.most || !std::isfinite(room) || !(room > 0.0)) return;
  // Stops are given roughly; ten times their distance beyond them is nowhere on the robot.
  constexpr double far = 10.0, roughly = 0.1;
  if (!(std::max(q.most - joint.upper, joint.lower - q.least) > far * room)) return;
  const auto fits = [&](double unit) {
    return q.most * unit <= joint.upper + roughly * room &&
           q.least * unit >= joint.lower - roughly * room;
  };
  const bool as_millimetres = fits(1e-3), as_centimetres = fits(1e-2);
  if (!as_millimetres && !as_centimetres) return;
  throw InputError(
      place(plan_.q + j, q.line),
      fmt::format("{:g} lies outside the limits {:g} to {:g} m: the unit looks like {}",
                  q.most > -q.least ? q.most : q.least, joint.lower, joint.upper,
                  !as_centimetres  ? "millimetres"
                  : as_millimetres ? "millimetres or centimetres"
                                   : "centimetres"),
      "give metres, or map with scale: 0.001 or 0.01");
}

void Plausibility::judge_angle(int j) const {
  const Joint& joint = robot_.joint(j);
  const Range& q = range(plan_.q + j);
  if (joint.kind != JointKind::revolute || q.least > q.most) return;
  const double past = std::max(q.most - joint.upper, joint.lower - q.least);
  const double most = std::max(-q.least, q.most);  // magnitude
  constexpr double turn = 2.0 * std::numbers::pi;
  for (const double offset : {turn, -turn}) {
    const bool fits = q.most + offset <= joint.upper && q.least + offset >= joint.lower;
    if (!(past > past_limit && fits)) continue;
    throw InputError(
        place(plan_.q + j, q.line),
        fmt::format("{:g} lies outside the limits {:g} to {:g} rad: it looks a whole turn off",
                    most == q.most ? q.most : q.least, joint.lower, joint.upper),
        fmt::format("map with offset: {:.17g}", offset));
  }
  const bool fits_as_degrees =
      q.most * degree <= joint.upper + degree && q.least * degree >= joint.lower - degree;
  if (past > past_limit && fits_as_degrees) {
    throw InputError(
        place(plan_.q + j, q.line),
        fmt::format("{:g} lies outside the limits {:g} to {:g} rad: the unit looks like degrees",
                    most == q.most ? q.most : q.least, joint.lower, joint.upper),
        fmt::format("give radians, or map with scale: {:.17g}", degree));
  }
  if (most > many_turns && std::isfinite(joint.lower) && std::isfinite(joint.upper)) {
    throw InputError(place(plan_.q + j, q.line),
                     fmt::format("{:g} rad on the limited joint {}", most, joint.name),
                     "give radians of the joint, not of the motor or in encoder counts");
  }
}

bool Plausibility::moves(int j) const {
  return moved_far(robot_.joint(j), range(plan_.q + j).width());
}

/// An offset of the velocity is no motion, and noise of single rows next to none over a span: it
/// must be as fast, span by span, as goes far in a second, and go as far.
bool Plausibility::moves_by_velocity(int j) const {
  const std::vector<Span>& spans = slopes_[static_cast<std::size_t>(j)].spans;
  double way = 0.0, seconds = 0.0;
  for (const Span& s : spans) {
    way += s.integral;
    seconds += s.seconds;
  }
  const double offset = seconds > 0.0 ? way / seconds : 0.0;
  double place = 0.0, squares = 0.0;
  ValueRange places;
  for (const Span& s : spans) {
    const double moved = s.integral - offset * s.seconds;
    squares += moved * moved / s.seconds;
    places.add(place += moved);
  }
  return seconds > 0.0 && moved_far(robot_.joint(j), std::sqrt(squares / seconds)) &&
         moved_far(robot_.joint(j), places.width());
}

double Plausibility::slope(int position, int velocity) const {
  return products_(position, velocity) / slopes_[static_cast<std::size_t>(position)].changes;
}

/// Zero where either is.
double Plausibility::correlation(int position, int velocity) const {
  const double squares = slopes_[static_cast<std::size_t>(position)].changes *
                         slopes_[static_cast<std::size_t>(velocity)].integrals;
  return squares > 0.0 ? products_(position, velocity) / std::sqrt(squares) : 0.0;
}

/// A velocity that has little to do with its own position, and is another's.
void Plausibility::judge_other_slopes(int j) const {
  constexpr double little = 0.5;
  if (std::abs(correlation(j, j)) > little) return;
  for (int other = 0; other < robot_.joint_count(); ++other) {
    if (!moves(other) || !(correlation(other, j) > correlated) || !near(slope(other, j), 1.0)) {
      continue;
    }
    throw InputError(place(plan_.dq + j),
                     fmt::format("is the derivative of {}, and not of {}",
                                 place(plan_.q + other).column, place(plan_.q + j).column),
                     "give position, velocity and torque of the same joint one name (mapping)");
  }
}

void Plausibility::judge_slope(int j) const {
  if (plan_.dq < 0 || !moves(j)) return;
  if (!(std::abs(correlation(j, j)) > correlated)) return judge_other_slopes(j);
  const double factor = slope(j, j);
  if (near(factor, 1.0)) return;
  std::string wrong =
      fmt::format("is {:.3g} times the derivative of {}", factor, place(plan_.q + j).column);
  std::string right = "give rad/s and rad (m/s and m) of the same joint, and seconds";
  if (near(factor, -1.0)) right = "give both the same sign (mapping: sign: -1)";
  if (near(factor, 1.0 / degree)) wrong += ": its unit looks like degrees per second";
  if (near(factor, degree)) wrong += ": the position's unit looks like degrees";
  if (near(factor, 1e3)) wrong += ": the clock looks like milliseconds taken for seconds";
  throw InputError(place(plan_.dq + j), wrong, right);
}

void Plausibility::judge_gravity() const {
  if (force_count_ < enough_rows) return;
  const double mean = force_sum_ / static_cast<double>(force_count_);
  constexpr double least = 0.6, most = 1.7;  // a gallop's mean magnitude is 1.2 g
  const auto between = [&](double unit) { return mean > least * unit && mean < most * unit; };
  if (between(gravity)) return;
  std::string right = "give the specific force in m/s^2, gravity included";
  if (between(1.0)) {
    right += "; the unit looks like g (scale: 9.80665)";
  } else if (between(1e3 * gravity)) {
    right += "; the unit looks like mm/s^2 (scale: 0.001)";
  } else if (mean <= least * gravity) {
    right += "; gravity seems to be removed (or the robot falls freely)";
  }
  throw InputError(place(plan_.accel),
                   fmt::format("the accelerometer's mean magnitude is {:.3g} m/s^2", mean), right);
}

/// By another axis of the gyro, or by blows from more than one side. A base that lies still, or
/// goes straight up, turns by less than a coarse gyro shows, and a simulated one not at all.
bool Plausibility::base_turns() const {
  constexpr double turns = 0.1, thrown = 1.0;  // rad/s, m/s^2
  int sides = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (range(plan_.gyro + axis).width() > turns) return true;
    if (range(plan_.accel + axis).width() > thrown) ++sides;
  }
  return sides > 1;
}

void Plausibility::judge_frozen() const {
  if (rows_ < enough_rows) return;
  const auto refuse = [&](int channel) {
    throw InputError(place(channel),
                     fmt::format("stays at {:g} while the joints move", range(channel).least),
                     "log the live signal, or leave the rows out");
  };
  bool any = false, torque = robot_.joint_count() == 0;
  for (int j = 0; j < robot_.joint_count(); ++j) {
    any = any || moves(j);
    torque = torque || range(plan_.tau + j).width() > 0.0;
    const Range& tau = range(plan_.tau + j);
    if (range(plan_.q + j).frozen() && moves_by_velocity(j)) refuse(plan_.q + j);
    // Zero is what a free joint has.
    if (moves(j) && tau.frozen() && tau.least != 0.0) refuse(plan_.tau + j);
  }
  if (any && !torque) {
    throw InputError(place(plan_.tau), "and every other torque never changes while the joints move",
                     "log the torque of every joint in N m");
  }
  for (const int imu : {plan_.gyro, plan_.accel}) {
    for (int axis = 0; any && plan_.floating() && axis < 3; ++axis) {
      const Range& reading = range(imu + axis);
      const bool may_rest = imu == plan_.gyro && !base_turns();
      if (!reading.frozen() || may_rest) continue;
      if (!(options_.exact && reading.least == 0.0)) refuse(imu + axis);
    }
  }
}

/// The grid of the whole log is that of its first rows: of faster ones it would pick some.
void Plausibility::judge_rate() {
  if (row_steps_.size() < enough_rows) return;
  const double step = median(row_steps_);
  if (first_median_ == 0.0) first_median_ = step;
  constexpr double another = 1.5;
  if (step * another > first_median_ && step < another * first_median_) return;
  throw InputError({path_, first_line_, plan_.time.from},
                   fmt::format("rows come {:.3g} times a second from about here on, and did {:.3g} "
                               "times before",
                               1.0 / step, 1.0 / first_median_),
                   "give logs of one rate: split this one where its rate changes");
}

}  // namespace shapeid
