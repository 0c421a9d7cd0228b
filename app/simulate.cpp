// shapeid simulate: a trotting quadruped, with or without a block on its back, writes a log.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "shapeid/app/bundled.hpp"
#include "shapeid/app/inputs.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/recording.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/robot_size.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::app {
namespace {

struct SimulateArguments {
  std::string robot, robot_yaml, out;
  SimulationOptions simulation;
  SensorOptions sensors;
  std::vector<double> load;
  bool exact = false, json = false;
};

/// By whatever name: what else is said would stand in the log.
bool is_standard_output(const std::string& path) {
  struct stat named {};
  struct stat open {};
  return ::stat(path.c_str(), &named) == 0 && ::fstat(STDOUT_FILENO, &open) == 0 &&
         named.st_dev == open.st_dev && named.st_ino == open.st_ino;
}

void simulate_log(SimulateArguments& options) {
  std::error_code unknown;  // what cannot be looked at is said when it is opened
  if (!options.out.ends_with(".csv") && !options.out.ends_with(".csv.gz") &&
      !std::filesystem::is_character_file(options.out, unknown) &&
      !std::filesystem::is_fifo(options.out, unknown)) {
    throw InputError({options.out}, "is no name of a log", "NAME.csv or NAME.csv.gz");
  }
  if (options.robot.empty()) {
    options.robot = bundled("quadruped.urdf");
    if (options.robot_yaml.empty()) options.robot_yaml = bundled("quadruped.robot.yaml");
  }
  UrdfOptions reading;
  reading.accepted_by.clear();  // a body that cannot be is not simulated
  Robot robot = read_urdf(options.robot, reading).robot;
  if (options.robot_yaml.empty()) {
    options.robot_yaml = robot_yaml_beside(options.robot);
    if (options.robot_yaml.empty()) {
      throw InputError("--robot without --robot-yaml", "its contacts must be named: give both");
    }
    tell(fmt::format("note: {}\n", remark_beside(options.robot_yaml)));
  }
  const RobotNotes notes = read_robot_yaml(options.robot_yaml, robot);
  if (!options.load.empty()) {
    Load load;
    load.mass = options.load[0];
    load.centre = {options.load[1], options.load[2], options.load[3]};
    if (options.load.size() == 5) load.sides.setConstant(options.load[4]);
    constexpr double heaviest = 1e4, furthest = 100.0;  // kg, m
    if (!(load.mass > 0.0 && load.mass <= heaviest) || !(load.sides[0] > 0.0) ||
        load.sides[0] > furthest || load.centre.cwiseAbs().maxCoeff() > furthest) {
      throw InputError(
          fmt::format("--load {}: no block that a robot could carry", fmt::join(options.load, " ")),
          "MASS X Y Z [SIDE], kg and m, mass and side above 0");
    }
    if (const auto why = why_too_far(load.centre.norm(), robot)) {
      throw InputError("--load: the block is " + *why, "metres, in the base's frame");
    }
    options.simulation.load = load;
    if (!(options.simulation.load_from < options.simulation.duration &&
          options.simulation.load_from < options.simulation.load_until)) {
      throw InputError(
          fmt::format("--load-from {}: the block is never there", options.simulation.load_from),
          fmt::format("a moment before --load-until and before the end of the log, {} s",
                      std::min(options.simulation.load_until, options.simulation.duration)));
    }
  }
  options.sensors.noise = !options.exact;
  options.sensors.exact_extras = options.exact;
  options.sensors.seed = options.simulation.seed;
  const SimulationReport report =
      record(robot, notes, options.simulation, options.sensors, options.out);
  std::string text = fmt::format("wrote {}: {} samples, walked {:.2f} m\n", options.out,
                                 report.samples, report.distance);
  if (options.json) {
    const nlohmann::json document = {
        {"log", options.out}, {"samples", report.samples}, {"distance", report.distance}};
    text = json_text(document, -1) + "\n";
  }
  if (is_standard_output(options.out)) {
    tell(text);
  } else {
    fmt::print("{}", text);
  }
}

}  // namespace

void add_simulate(CLI::App& app) {
  const auto options = std::make_shared<SimulateArguments>();
  CLI::App* verb = app.add_subcommand("simulate", "a trotting quadruped in Simbody writes a log");
  verb->add_option("--out", options->out, "log to write, .csv or .csv.gz")->required();
  verb->add_option("--robot", options->robot, "URDF of a quadruped (default: the bundled one)");
  verb->add_option("--robot-yaml", options->robot_yaml, "its contacts, IMU pose and noise");
  verb->add_option("--seconds", options->simulation.duration, "s")
      ->check(number_from(0.1, 3600.0, "s"))
      ->capture_default_str();
  verb->add_option("--rate", options->simulation.rate, "Hz, of the samples")
      ->check(number_from(50.0, 5000.0, "Hz"))
      ->capture_default_str();
  verb->add_option("--seed", options->simulation.seed, "of the wanted motion and of the noise")
      ->check(count_from(0))
      ->capture_default_str();
  auto* load =
      verb->add_option("--load", options->load,
                       "MASS X Y Z [SIDE]: a block fixed to the base, kg and m (side 0.04)")
          ->expected(4, 5);
  verb->add_option("--load-from", options->simulation.load_from, "s: when the block is put on")
      ->check(zero_or_above())
      ->needs(load)
      ->capture_default_str();
  verb->add_option("--load-until", options->simulation.load_until, "s: when it is taken off again")
      ->check(above_zero())
      ->needs(load);
  verb->add_flag("--exact", options->exact,
                 "no noise; accelerations and contact forces are logged as well");
  verb->add_flag("--json", options->json, "print JSON");
  verb->callback([options] { simulate_log(*options); });
}

}  // namespace shapeid::app
