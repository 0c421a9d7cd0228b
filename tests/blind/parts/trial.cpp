#include "shapeid/tests/blind/parts/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "shapeid/models/file_output.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/simbody/sensors.hpp"
#include "shapeid/models/simbody/simulation.hpp"
#include "shapeid/models/simbody/tracking.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::blind {
namespace {

using nlohmann::json;

const std::map<Acts, std::string> acts_words = {{Acts::as_usual, "as usual"},
                                                {Acts::in_log, "in the log"},
                                                {Acts::in_reference, "in the reference log"}};

Ingredients ingredients(const Machine& machine, const std::vector<Item>& items) {
  Ingredients in;
  in.robot = machine.robot;
  for (const Item& item : items) kind(item.kind).put(in, machine, item.amount);
  return in;
}

Readings simulate(const Machine& machine, const Ingredients& in, std::uint64_t seed) {
  Readings readings;
  constexpr double accuracy = 1e-4;  // motion to a tenth of a millimetre: any motion will do
  const double duration = fitted_seconds + tested_seconds;
  if (machine.robot.root == Root::fixed) {
    TrackingOptions options;
    options.wanted.duration = duration;
    options.wanted.rate = machine.rate;
    options.wanted.frequency = machine.frequency;
    options.wanted.seed = seed;
    options.load = in.load;
    options.load_from = in.load_from;
    options.disturbance = in.disturbance();
    options.accuracy = accuracy;
    simulate_tracking(in.robot, options, [&](const Sample& s) {
      readings.push_back({s, Eigen::Quaterniond::Identity()});
    });
    return readings;
  }
  SimulationOptions options;
  options.duration = duration;
  options.rate = machine.rate;
  options.trot = machine.trot;
  options.seed = seed;
  options.ground = in.ground;
  options.load = in.load;
  options.load_from = in.load_from;
  options.disturbance = in.disturbance();
  options.accuracy = accuracy;
  const SimulationReport report =
      shapeid::simulate(in.robot, options, [&](const SimulatedSample& s) {
        readings.push_back({s.sample, Eigen::Quaterniond(s.state.base.linear())});
      });
  if (report.fell_at) readings.clear();
  return readings;
}

}  // namespace

bool needs_reference(const Trial& trial) {
  return std::any_of(trial.items.begin(), trial.items.end(),
                     [](const Item& item) { return item.kind == "payload"; });
}

std::vector<Item> without_loads(std::vector<Item> items) {
  std::erase_if(items, [](const Item& item) { return kind(item.kind).load; });
  return items;
}

std::vector<Item> items_in_log(const Trial& trial) {
  return trial.acts == Acts::in_reference ? std::vector<Item>{} : trial.items;
}

std::vector<Item> items_in_reference(const Trial& trial) {
  switch (trial.acts) {
    case Acts::in_log:
      return {};
    case Acts::in_reference:
      return trial.items;
    case Acts::as_usual:
      break;
  }
  return without_loads(trial.items);
}

json to_json(const Trial& trial) {
  json items = json::array();
  for (const Item& item : trial.items) {
    const Eigen::Vector3d& d = item.amount.direction;
    items.push_back({{"kind", item.kind},
                     {"site", item.amount.site},
                     {"size", item.amount.size},
                     {"direction", {d.x(), d.y(), d.z()}},
                     {"ratio", item.ratio}});
  }
  return {{"machine", trial.machine},
          {"motion_seed", trial.motion_seed},
          {"noise_seed", trial.noise_seed},
          {"inertia_seed", trial.inertia_seed},
          {"items", items},
          {"reference", trial.reference},
          {"reference_needed", needs_reference(trial)},
          {"acts", acts_words.at(trial.acts)},
          {"error", trial.error}};
}

Trial trial_from_json(const json& document) {
  Trial trial;
  trial.machine = document.at("machine");
  trial.motion_seed = document.at("motion_seed");
  trial.noise_seed = document.at("noise_seed");
  trial.inertia_seed = document.at("inertia_seed");
  trial.error = document.at("error");
  for (const json& item : document.at("items")) {
    const json& d = item.at("direction");
    trial.items.push_back(
        {item.at("kind"),
         {item.at("site"), item.at("size"),
          Eigen::Vector3d(d.at(0).get<double>(), d.at(1).get<double>(), d.at(2).get<double>())},
         item.at("ratio")});
  }
  trial.reference = document.value("reference", needs_reference(trial));
  const std::string acts = document.value("acts", acts_words.at(Acts::as_usual));
  for (const auto& [which, words] : acts_words) {
    if (words == acts) trial.acts = which;
  }
  return trial;
}

Readings simulate_clean(const Machine& machine, std::uint64_t motion_seed) {
  return simulate(machine, ingredients(machine, {}), motion_seed);
}

Readings simulate_trial(const Machine& machine, const Trial& trial) {
  const Ingredients in = ingredients(machine, trial.items);
  Readings readings = simulate(machine, in, trial.motion_seed);
  if (readings.empty()) return readings;
  for (const auto& change : in.signals) change(readings);
  return readings;
}

void change_signals(const Machine& machine, const std::vector<Item>& items, Readings& readings) {
  for (const auto& change : ingredients(machine, items).signals) change(readings);
}

bool is_dynamic(const Trial& trial) {
  return std::any_of(trial.items.begin(), trial.items.end(),
                     [](const Item& item) { return kind(item.kind).dynamic; });
}

void write_logs(const Machine& machine, const Trial& trial, const Readings& readings,
                const std::string& folder) {
  SensorOptions options;
  options.seed = trial.noise_seed;
  Sensors sensors(machine.robot, machine.notes, options);
  LogWriter log(folder + "/log.csv", sensors.columns()),
      test(folder + "/test.csv", sensors.columns());
  for (const Reading& r : readings) {
    (r.sample.time < fitted_seconds ? log : test).write(sensors.measure(r.sample, r.attitude));
  }
  log.close();
  test.close();
  std::vector<IdentifiedLink> given;
  const auto wrong = wrong_inertias(machine, trial.inertia_seed);
  for (std::size_t i = 0; i < wrong.size(); ++i) given.push_back({machine.free_links[i], wrong[i]});
  // Replaced at once: what is rewritten must be a file.
  const std::string urdf = folder + "/given.urdf";
  write_file(urdf, machine.urdf);
  write_file(urdf, write_urdf(urdf, machine.robot, given));
  write_file(folder + "/given.robot.yaml", machine.yaml);
  write_file(folder + "/cutoff", fmt::format("{:g}\n", machine.cutoff));
}

}  // namespace shapeid::blind
