// shapeid inspect: what is in a robot or a log, and what is wrong with it, before any fit.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "shapeid/app/inputs.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

struct InspectArguments {
  std::string file;
  MotionInputs inputs;
  bool json = false;
};

json robot_json(const UrdfFile& file) {
  json links = json::array(), findings = json::array();
  for (const Link& link : file.robot.links) {
    const Eigen::Vector3d c = link.inertia.centre_of_mass();
    links.push_back({{"name", link.name},
                     {"members", link.members.size()},
                     {"mass", link.inertia.mass()},
                     {"centre", {c.x(), c.y(), c.z()}},
                     {"consistency_margin", consistency_margin(link.inertia)},
                     {"collision_bodies", link.collision.size()}});
  }
  for (const InertiaFinding& f : file.findings) {
    findings.push_back({{"link", f.link},
                        {"file", f.place.file},
                        {"line", f.place.line},
                        {"wrong", f.wrong},
                        {"likely_cause", f.likely_cause},
                        {"fatal", f.fatal}});
  }
  return {{"robot", file.robot.name},
          {"links", links},
          {"findings", findings},
          {"notes", file.robot.notes}};
}

std::string robot_text(const UrdfFile& file) {
  const Robot& robot = file.robot;
  std::string text = fmt::format("robot {}: {} links after lumping, {} joints, {:.4g} kg\n",
                                 robot.name, robot.link_count(), robot.joint_count(), robot.mass());
  text += fmt::format("  {:<28}{:>10}  {:<34}{:>8}\n", "link", "mass (kg)", "centre of mass (m)",
                      "margin");
  for (const Link& link : robot.links) {
    const Eigen::Vector3d c = link.inertia.centre_of_mass();
    const std::string centre = fmt::format("({:.4g}, {:.4g}, {:.4g})", c.x(), c.y(), c.z());
    text += fmt::format("  {:<28}{:>10.4g}  {:<34}{:>8.2g}\n", link.name, link.inertia.mass(),
                        centre, consistency_margin(link.inertia));
  }
  for (const InertiaFinding& f : file.findings) {
    text += fmt::format("{}: {}: link {}: {}{}\n", f.fatal ? "impossible" : "suspicious",
                        describe(f.place), f.link, f.wrong,
                        f.likely_cause.empty() ? "" : "; likely cause: " + f.likely_cause);
  }
  for (const std::string& note : robot.notes) text += fmt::format("note: {}\n", note);
  return text;
}

void inspect_robot(const InspectArguments& options) {
  UrdfOptions reading;
  reading.reject_impossible = false;
  UrdfFile file = read_urdf(options.file, reading);
  // A URDF does not say that its base is fixed. One without mass cannot float, and does not move.
  if (file.robot.links.front().inertia.mass() == 0.0 && !file.says_floating) {
    reading.root = Root::fixed;
    file = read_urdf(options.file, reading);
  }
  fmt::print("{}", options.json ? json_text(robot_json(file), 2) + "\n" : robot_text(file));
  const auto fatal = std::count_if(file.findings.begin(), file.findings.end(),
                                   [](const InertiaFinding& f) { return f.fatal; });
  if (fatal > 0) {
    throw Refusal("impossible-inertia",
                  fmt::format("{} of {} findings are inertias that no body can have", fatal,
                              file.findings.size()));
  }
}

/// Range of one column of a log.
struct Range {
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();
  double sum = 0.0;
  std::size_t count = 0, empty = 0;

  void add(double x) {
    if (std::isnan(x)) {
      ++empty;
      return;
    }
    lower = std::min(lower, x);
    upper = std::max(upper, x);
    sum += x;
    ++count;
  }
};

void inspect_columns(const InspectArguments& options) {
  LogReader reader(options.file);
  const std::vector<std::string> columns = reader.columns();
  std::vector<Range> ranges(columns.size());
  std::size_t rows = 0;
  while (const std::optional<LogRow> row = reader.next()) {
    for (std::size_t i = 0; i < columns.size(); ++i) ranges[i].add(row->values[i]);
    ++rows;
  }
  if (options.json) {
    json list = json::array();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Range& r = ranges[i];
      json entry = {{"name", columns[i]}, {"numbers", r.count}, {"empty", r.empty}};
      if (r.count > 0) {
        entry["lower"] = r.lower;
        entry["upper"] = r.upper;
        entry["mean"] = r.sum / static_cast<double>(r.count);
      }
      list.push_back(entry);
    }
    fmt::print("{}\n", json_text({{"log", options.file}, {"rows", rows}, {"columns", list}}, 2));
    return;
  }
  // A name in a log may hold anything that a terminal would act on.
  constexpr std::size_t longest_name = 200, longest_path = 2000;
  fmt::print("log {}: {} rows, {} columns\n", one_line(options.file, longest_path), rows,
             columns.size());
  fmt::print("  {:<32}{:>12}{:>12}{:>12}{:>9}\n", "column", "lower", "mean", "upper", "empty");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Range& r = ranges[i];
    const std::string name = one_line(columns[i], longest_name);
    if (r.count == 0) {
      fmt::print("  {:<32}{:>36}{:>9}\n", name, "no number", r.empty);
      continue;
    }
    fmt::print("  {:<32}{:>12.5g}{:>12.5g}{:>12.5g}{:>9}\n", name, r.lower,
               r.sum / static_cast<double>(r.count), r.upper, r.empty);
  }
}

void inspect_motion(InspectArguments& options) {
  options.inputs.log = options.file;
  const RobotInputs robot = read_robot(options.inputs);
  LogSamples samples(options.file, robot, options.inputs);
  std::vector<std::size_t> touching(robot.robot.contacts.size(), 0);
  double first = 0.0, last = 0.0;
  std::size_t count = 0;
  while (const std::optional<Sample> sample = samples.next()) {
    if (count++ == 0) first = sample->time;
    last = sample->time;
    for (std::size_t c = 0; c < sample->in_contact.size(); ++c)
      touching[c] += sample->in_contact[c];
  }
  const MotionReport& report = samples.report();
  std::vector<std::string> notes = robot.remarks;
  notes.insert(notes.end(), robot.warnings.begin(), robot.warnings.end());
  notes.insert(notes.end(), report.notes.begin(), report.notes.end());
  json contacts = json::object();
  for (std::size_t c = 0; c < touching.size(); ++c) {
    contacts[robot.robot.contacts[c].name] =
        static_cast<double>(touching[c]) / static_cast<double>(std::max<std::size_t>(count, 1));
  }
  const json document = {{"rows", report.rows},
                         {"samples", report.samples},
                         {"seconds", last - first},
                         {"rate", report.rate},
                         {"gaps", report.gaps},
                         {"dropped_rows", report.dropped_rows},
                         {"dropped_at_ends", report.dropped_at_ends},
                         {"dropped_at_contacts", report.dropped_at_contacts},
                         {"floating", report.floating},
                         {"contacts_derived", report.contacts_derived},
                         {"share_of_time_in_contact", contacts},
                         {"extra_columns", report.extra},
                         {"notes", notes}};
  if (options.json) {
    fmt::print("{}\n", json_text(document, 2));
    return;
  }
  for (const auto& item : document.items())
    fmt::print("{:<26} {}\n", item.key(), json_text(item.value(), -1));
}

/// XML begins with one character, whatever its file is called, and no log does.
bool begins_as_xml(const std::string& file) {
  std::error_code unknown;  // what cannot be looked at is said when it is read
  if (!std::filesystem::is_regular_file(file, unknown)) return false;
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4096> head{};
  in.read(head.data(), head.size());
  std::string_view text(head.data(), static_cast<std::size_t>(in.gcount()));
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '<';
}

void inspect(InspectArguments& options) {
  const bool is_robot = options.file.ends_with(".urdf") || options.file.ends_with(".xml") ||
                        begins_as_xml(options.file);
  if (is_robot && !options.inputs.robot.empty()) {
    throw InputError({options.file}, "is a robot itself", "--robot goes with a log");
  }
  if (is_robot) {
    inspect_robot(options);
  } else if (options.inputs.robot.empty()) {
    inspect_columns(options);
  } else {
    inspect_motion(options);
  }
}

}  // namespace

void add_inspect(CLI::App& app) {
  const auto options = std::make_shared<InspectArguments>();
  CLI::App* verb =
      app.add_subcommand("inspect", "what is in a URDF or a log, and what is wrong with it");
  verb->add_option("file", options->file, "robot.urdf, log.csv or log.csv.gz")->required();
  auto* robot = verb->add_option("--robot", options->inputs.robot,
                                 "URDF: read the log as this robot's motion");
  verb->add_option("--mapping", options->inputs.mapping, "mapping.yaml of the log")->needs(robot);
  verb->add_option("--robot-yaml", options->inputs.robot_yaml, "robot.yaml (default: beside)")
      ->needs(robot);
  verb->add_flag("--accept-impossible", options->inputs.accept_impossible,
                 "read a robot with inertias that no body can have, too")
      ->needs(robot);
  options->inputs.add_smoothing_to(*verb);
  for (const char* option : {"--cutoff", "--rate", "--exact"}) {
    verb->get_option(option)->needs(robot);
  }
  verb->add_flag("--json", options->json, "print JSON");
  verb->callback([options] { inspect(*options); });
}

}  // namespace shapeid::app
