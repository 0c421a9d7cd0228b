#include "shapeid/models/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "shapeid/models/error.hpp"
#include "shapeid/models/lower_case.hpp"

namespace shapeid {
namespace {

constexpr int header_line = 1;
constexpr std::array<const char*, 3> axes = {"x", "y", "z"};

std::vector<std::string> with_axes(const std::string& quantity) {
  std::vector<std::string> names;
  names.reserve(axes.size());
  for (const char* axis : axes) names.push_back(quantity + "." + axis);
  return names;
}

/// "i3_A", "motor_current_knee", "tau_motor": what is called so is not a joint torque.
bool sounds_like_current_or_motor(const std::string& name) {
  const std::string lower = lower_case(name);
  constexpr std::array<std::string_view, 3> words = {"current", "amp", "motor"};
  constexpr std::array<std::string_view, 2> units = {"_a", "_ma"};
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view w) { return lower.find(w) != std::string::npos; }) ||
         std::any_of(units.begin(), units.end(),
                     [&](std::string_view u) { return lower.ends_with(u); });
}

/// Looks names up in a log, through a mapping if there is one, and remembers what was used.
class Finder {
 public:
  Finder(const LogTable& log, const std::optional<Mapping>& mapping)
      : path_(log.path()), mapping_(mapping) {
    for (std::size_t i = 0; i < log.columns().size(); ++i) columns_[log.columns()[i]] = i;
    if (!mapping) return;
    for (const auto& [ours, rule] : mapping->columns) {
      if (column(rule.from)) continue;
      throw InputError(
          mapping->at(rule),
          fmt::format("{} is to be column {}, which {} does not have", ours, rule.from, path_),
          "name a column of the log");
    }
  }

  [[nodiscard]] bool has(const std::string& ours) const {
    return rule(ours) != nullptr || columns_.contains(ours);
  }
  [[nodiscard]] bool has_any(const std::vector<std::string>& names) {
    asked_.insert(names.begin(), names.end());
    return std::any_of(names.begin(), names.end(),
                       [&](const std::string& name) { return has(name); });
  }

  /// Index of a column of the log, which counts as used then; none where there is no such column.
  std::optional<std::size_t> column(const std::string& from) {
    const auto found = columns_.find(from);
    if (found == columns_.end()) return std::nullopt;
    used_.insert(from);
    return found->second;
  }

  Channel find(const std::string& ours) {
    asked_.insert(ours);
    const ColumnRule* const r = rule(ours);
    const std::string from = r == nullptr ? ours : r->from;
    use_once(from, ours);
    const std::optional<std::size_t> at = column(from);
    if (!at) {  // of a rule it is there: the mapping was looked at first
      throw InputError({path_, header_line}, fmt::format("has no column {}", from),
                       "add it, or name its source in a mapping file");
    }
    if (r == nullptr) return {ours, ours, *at};
    Channel channel{ours, from, *at, r->sign * r->scale, r->offset};
    if (!r->hold.empty()) {
      channel.hold_group =
          groups_.try_emplace(r->hold, static_cast<int>(groups_.size())).first->second;
    }
    return channel;
  }

  /// Appends all of `names`; -1 if the log has none of them and need not.
  int append(const std::vector<std::string>& names, bool required, std::vector<Channel>& channels) {
    if (!required && !has_any(names)) return -1;
    const int start = static_cast<int>(channels.size());
    for (const std::string& name : names) channels.push_back(find(name));
    return start;
  }

  /// Throws if the mapping makes a column that nobody asked for, however it was meant.
  void check_targets(const Robot& robot) const {
    if (!mapping_) return;
    for (const auto& [ours, rule] : mapping_->columns) {
      if (asked_.contains(ours)) continue;
      throw InputError(mapping_->at(rule),
                       fmt::format("{} is made of column {}, and means nothing for {}", ours,
                                   rule.from, robot.name),
                       "make time, base.gyro, base.accel, q, dq, ddq or tau of its joints, contact "
                       "or force of its contacts");
    }
  }

  [[nodiscard]] int groups() const { return static_cast<int>(groups_.size()); }
  [[nodiscard]] std::vector<std::string> unused() const {
    std::vector<std::string> names;
    for (const auto& [name, index] : columns_) {
      if (!used_.contains(name)) names.push_back(name);
    }
    return names;
  }

 private:
  /// A signal is one quantity; contacts of one foot may share a flag.
  void use_once(const std::string& from, const std::string& ours) {
    if (ours.starts_with("contact.")) return;
    const auto [first, is_new] = makes_.try_emplace(from, ours);
    if (is_new || first->second == ours) return;
    // Names in a log are there once: one of the two at least is a rule.
    const ColumnRule* const either = rule(ours) != nullptr ? rule(ours) : rule(first->second);
    throw InputError(
        mapping_->at(*either),
        fmt::format("column {} of {} is to be {} and {}", from, path_, first->second, ours),
        "a column of its own for each, in the log or in the mapping");
  }

  [[nodiscard]] const ColumnRule* rule(const std::string& ours) const {
    if (!mapping_) return nullptr;
    const auto found = mapping_->columns.find(ours);
    return found == mapping_->columns.end() ? nullptr : &found->second;
  }

  std::string path_;
  const std::optional<Mapping>& mapping_;
  std::map<std::string, std::size_t> columns_;
  std::set<std::string> used_, asked_;
  std::map<std::string, std::string> makes_;  ///< of each column that is used what it is
  std::map<std::string, int> groups_;
};

/// Puts gears and drive gains into the scales of the torque channels.
void declare_torque(const std::optional<Mapping>& mapping, const std::string& path,
                    const Robot& robot, ChannelPlan& plan) {
  const TorqueKind kind = mapping && mapping->torque ? *mapping->torque : TorqueKind::joint;
  for (int j = 0; j < robot.joint_count(); ++j) {
    Channel& tau = plan.channels[static_cast<std::size_t>(plan.tau) + static_cast<std::size_t>(j)];
    const std::string& joint = robot.joint(j).name;
    if (!(mapping && mapping->torque) && tau.from != tau.name &&
        sounds_like_current_or_motor(tau.from)) {
      throw InputError(
          mapping->at(mapping->columns.at(tau.name)),
          fmt::format("{} is to be column {} of {}, which sounds like a current or a motor-side "
                      "torque",
                      tau.name, tau.from, path),
          "declare torque: {kind: joint | motor | current, factor} in the mapping");
    }
    if (kind == TorqueKind::joint) continue;
    const auto factor = mapping->torque_factor.find(joint);
    if (factor == mapping->torque_factor.end()) {
      throw InputError(mapping->at_torque(),
                       fmt::format("there is no torque factor for joint {}", joint),
                       kind == TorqueKind::motor ? "give the gear ratio of every joint"
                                                 : "give N m per A of every joint");
    }
    tau.scale *= factor->second;
    tau.offset *= factor->second;
  }
  if (mapping) {
    for (const auto& [joint, factor] : mapping->torque_factor) {
      if (robot.find_joint(joint)) continue;
      throw InputError(mapping->at_factor(joint),
                       fmt::format("{} has a torque factor, and is no joint that moves", joint),
                       fmt::format("name joints of {} that move", robot.name));
    }
  }
}

void check_root(Finder& finder, const std::string& path, const Robot& robot) {
  std::vector<std::string> base = with_axes("base.gyro");
  for (const std::string& name : with_axes("base.accel")) base.push_back(name);
  const bool floating = finder.has_any(base);
  if (floating && robot.root == Root::fixed) {
    throw InputError({path, header_line},
                     "has base.gyro.* or base.accel.* columns, but the robot's root is fixed",
                     "read the robot with a floating root, or leave the base.* columns out");
  }
  if (!floating && robot.root == Root::floating) {
    throw InputError(
        {path, header_line},
        "has no base.gyro.* and base.accel.* columns, but the robot's root floats",
        "read the robot with a fixed root, or log base.gyro.{x,y,z} and base.accel.{x,y,z}");
  }
}

void check_contacts(const LogTable& log, const std::optional<Mapping>& mapping,
                    const Robot& robot) {
  for (const std::string& name : contact_names(log, mapping)) {
    const bool known = std::any_of(robot.contacts.begin(), robot.contacts.end(),
                                   [&](const Contact& c) { return c.name == name; });
    if (!known) {
      throw InputError(place_of_column("contact." + name, log, mapping),
                       robot.find_link(name) ? "is no contact of the robot"
                                             : fmt::format("the robot has no link {}", name),
                       "name links of the URDF, and declare them as contacts in robot.yaml");
    }
  }
}

}  // namespace

std::vector<std::string> contact_names(const LogTable& log, const std::optional<Mapping>& mapping) {
  constexpr std::string_view prefix = "contact.";
  std::set<std::string> names;
  const auto collect = [&](const std::string& name) {
    if (name.starts_with(prefix)) names.insert(name.substr(prefix.size()));
  };
  for (const std::string& name : log.columns()) collect(name);
  if (mapping) {
    for (const auto& [name, rule] : mapping->columns) collect(name);
  }
  return {names.begin(), names.end()};
}

Place place_of_column(const std::string& ours, const LogTable& log,
                      const std::optional<Mapping>& mapping) {
  if (mapping) {
    if (const auto rule = mapping->columns.find(ours); rule != mapping->columns.end()) {
      return {mapping->file, rule->second.line, ours};
    }
  }
  return {log.path(), header_line, ours};
}

ChannelPlan plan_channels(const LogTable& log, const Robot& robot,
                          const std::optional<Mapping>& mapping) {
  Finder finder(log, mapping);
  check_root(finder, log.path(), robot);
  check_contacts(log, mapping, robot);

  const auto per_joint = [&](const std::string& quantity) {
    std::vector<std::string> names;
    names.reserve(static_cast<std::size_t>(robot.joint_count()));
    for (int j = 0; j < robot.joint_count(); ++j) {
      names.push_back(quantity + "." + robot.joint(j).name);
    }
    return names;
  };
  std::vector<std::string> force, contact;
  for (const Contact& c : robot.contacts) {
    contact.push_back("contact." + c.name);
    for (const std::string& name : with_axes("force." + c.name)) force.push_back(name);
  }

  ChannelPlan plan;
  plan.time = finder.find("time");
  if (robot.root == Root::floating) {
    plan.gyro = finder.append(with_axes("base.gyro"), true, plan.channels);
    plan.accel = finder.append(with_axes("base.accel"), true, plan.channels);
    plan.gyrodot = finder.append(with_axes("base.gyrodot"), false, plan.channels);
  }
  plan.q = finder.append(per_joint("q"), true, plan.channels);
  // Without joints there is nothing to miss.
  const bool has_all = robot.joint_count() == 0;
  plan.dq = finder.append(per_joint("dq"), has_all, plan.channels);
  plan.ddq = finder.append(per_joint("ddq"), has_all, plan.channels);
  plan.tau = finder.append(per_joint("tau"), true, plan.channels);
  plan.force = finder.append(force, false, plan.channels);
  finder.append(contact, false, plan.contacts);
  finder.check_targets(robot);
  declare_torque(mapping, log.path(), robot, plan);

  if (mapping) {
    for (const auto& [name, value] : mapping->keep_rows) {
      const std::optional<std::size_t> column = finder.column(name);
      if (!column) {
        throw InputError(
            mapping->at_kept(name),
            fmt::format("rows are kept by column {}, which {} does not have", name, log.path()),
            "name a column of the log");
      }
      plan.keep.push_back({*column, value});
    }
  }
  plan.hold_groups = finder.groups();
  plan.extra = finder.unused();
  for (const std::string& name : plan.extra) {
    const auto at = std::find(log.columns().begin(), log.columns().end(), name);
    plan.extra_columns.push_back(static_cast<std::size_t>(at - log.columns().begin()));
  }
  return plan;
}

RowMeaning::RowMeaning(const LogTable& log, const Robot& robot,
                       const std::optional<Mapping>& mapping)
    : path_(log.path()),
      plan_(plan_channels(log, robot, mapping)),
      held_(plan_.channels.size(), std::numeric_limits<double>::quiet_NaN()) {}

bool RowMeaning::kept(const LogRow& row) const {
  return std::all_of(plan_.keep.begin(), plan_.keep.end(), [&](const ChannelPlan::Keep& keep) {
    return row.values[keep.column] == keep.value;
  });
}

double RowMeaning::time(const LogRow& row) const {
  const double time = plan_.time.scale * row.values[plan_.time.column] + plan_.time.offset;
  if (std::isnan(time)) {
    throw InputError({path_, row.line, plan_.time.from}, "is empty", "give every row its time");
  }
  // s: thirty thousand years. Beyond, doubles tell no samples apart.
  constexpr double latest = 1e12;
  if (!(std::abs(time) < latest)) {
    throw InputError({path_, row.line, plan_.time.from}, fmt::format("is {:g} s", time),
                     "give seconds; nanoseconds take scale: 1e-9");
  }
  return time;
}

std::vector<int> RowMeaning::contacts(const LogRow& row) const {
  std::vector<int> flags;
  for (const Channel& contact : plan_.contacts) {
    const double flag = contact.scale * row.values[contact.column] + contact.offset;
    if (!(std::isnan(flag) || flag == 0.0 || flag == 1.0 || flag == -1.0)) {
      throw InputError({path_, row.line, contact.from}, fmt::format("{} is no flag", flag),
                       "write 1 for touching, 0 for not, -1 or nothing for not known");
    }
    flags.push_back(std::isnan(flag) ? -1 : static_cast<int>(flag));
  }
  return flags;
}

/// Leaves only new measurements: a sample-and-hold group repeats its values until a new one comes.
void RowMeaning::blank_held(const LogRow& row, Eigen::VectorXd& values) {
  std::vector<bool> fresh(static_cast<std::size_t>(plan_.hold_groups), false);
  for (std::size_t c = 0; c < plan_.channels.size(); ++c) {
    const Channel& channel = plan_.channels[c];
    const double value = row.values[channel.column];
    if (channel.hold_group < 0 || std::isnan(value) || value == held_[c]) continue;
    fresh[static_cast<std::size_t>(channel.hold_group)] = true;
    held_[c] = value;
  }
  for (std::size_t c = 0; c < plan_.channels.size(); ++c) {
    const int group = plan_.channels[c].hold_group;
    if (group >= 0 && !fresh[static_cast<std::size_t>(group)]) {
      values[static_cast<Eigen::Index>(c)] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

MeasuredRow RowMeaning::read(const LogRow& row) {
  MeasuredRow measured{row.line,
                       time(row),
                       Eigen::VectorXd(static_cast<Eigen::Index>(plan_.channels.size())),
                       contacts(row),
                       {}};
  for (const std::size_t column : plan_.extra_columns) {
    measured.extra.push_back(row.values[column]);
  }
  for (std::size_t c = 0; c < plan_.channels.size(); ++c) {
    const Channel& channel = plan_.channels[c];
    measured.values[static_cast<Eigen::Index>(c)] =
        channel.scale * row.values[channel.column] + channel.offset;
  }
  blank_held(row, measured.values);
  return measured;
}

MeasuredRows::MeasuredRows(const std::string& path, const Robot& robot,
                           const std::optional<Mapping>& mapping)
    : log_(path), meaning_(log_.table(), robot, mapping) {}

void MeasuredRows::check_clock(const MeasuredRow& row) {
  if (last_time_ && row.time <= *last_time_) {
    throw InputError(
        {log_.path(), row.line, plan().time.from},
        row.time == *last_time_
            ? fmt::format("the clock stands still at {} s", row.time)
            : fmt::format("the clock runs back from {} to {} s", *last_time_, row.time),
        "give rows in increasing time, each time once");
  }
  constexpr double longest_pause = 86400.0;  // s: what begins a day later is another log
  if (last_time_ && row.time - *last_time_ > longest_pause) {
    throw InputError({log_.path(), row.line, plan().time.from},
                     fmt::format("the clock jumps from {} to {} s", *last_time_, row.time),
                     "give seconds; nanoseconds take scale: 1e-9");
  }
  last_time_ = row.time;
}

std::optional<MeasuredRow> MeasuredRows::next() {
  while (const std::optional<LogRow> row = log_.next()) {
    ++rows_;
    if (!meaning_.kept(*row)) {
      ++filtered_;
      continue;
    }
    MeasuredRow measured = meaning_.read(*row);
    check_clock(measured);
    return measured;
  }
  return std::nullopt;
}

}  // namespace shapeid
