// shapeid demo: the main job on bundled data, from simulation to report, in a minute.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "shapeid/app/bundled.hpp"
#include "shapeid/app/gnuplot.hpp"
#include "shapeid/app/html.hpp"
#include "shapeid/app/identification.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/output_folder.hpp"
#include "shapeid/app/plots.hpp"
#include "shapeid/app/recording.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/simbody/load.hpp"

namespace shapeid::app {
namespace {

using Table = std::vector<std::vector<std::string>>;

constexpr double demo_seconds = 10.0;
constexpr std::uint64_t seed = 7;

struct Demo {
  std::string folder;
  bool json = false;  ///< print one JSON document instead of tables
  Page page{"shapeid: a quadruped's base and its load, from joints and IMU alone"};
  nlohmann::json document = nlohmann::json::object();
  std::vector<OutputFile> pictures;

  [[nodiscard]] std::string file(const std::string& name) const {
    return (std::filesystem::path(folder) / name).string();
  }
};

/// What the demo's two parts have in common: a log of the bundled robot, and how it is read.
MotionInputs record_log(const Demo& demo, const std::string& name,
                        const std::optional<Load>& load) {
  MotionInputs inputs;
  inputs.robot = bundled("quadruped.urdf");
  inputs.robot_yaml = bundled("quadruped.robot.yaml");
  inputs.log = demo.file(name);
  inputs.cutoff = 80.0;  // Hz; the best pair of docs/recovery.md for a trot of this pace
  inputs.row_cutoff = 20.0;
  Robot robot = read_urdf(inputs.robot).robot;
  const RobotNotes notes = read_robot_yaml(inputs.robot_yaml, robot);
  SimulationOptions simulation;
  simulation.duration = demo_seconds;
  simulation.seed = seed;
  simulation.load = load;
  SensorOptions sensors;
  sensors.seed = seed;
  record(robot, notes, simulation, sensors, inputs.log);
  return inputs;
}

std::string five_digits(double x) { return fmt::format("{:.5g}", x); }

/// Truth against found, kg, m and kg m^2 apart: one row each, never one norm over mixed units.
Table truth_table(const InertialParameters& truth, const InertialParameters& found) {
  Table table = {{"", "unit", "truth", "found", "error"}};
  const auto row = [&](const std::string& name, const std::string& unit, double t, double f) {
    table.push_back({name, unit, five_digits(t), five_digits(f), fmt::format("{:+.2g}", f - t)});
  };
  row("mass", "kg", truth.mass(), found.mass());
  const Eigen::Vector3d ct = truth.centre_of_mass(), cf = found.centre_of_mass();
  row("centre x", "m", ct.x(), cf.x());
  row("centre y", "m", ct.y(), cf.y());
  row("centre z", "m", ct.z(), cf.z());
  const Eigen::Matrix3d It = truth.tensor_about_centre(), If = found.tensor_about_centre();
  constexpr std::array<const char*, 3> axis = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const std::string name = std::string("I") + axis[static_cast<std::size_t>(i)] +
                               axis[static_cast<std::size_t>(j)] + " about centre";
      row(name, "kg m^2", It(i, j), If(i, j));
    }
  }
  return table;
}

/// Ten parameters each, shapeid's order.
nlohmann::json comparison_json(const InertialParameters& truth, const InertialParameters& found) {
  const auto list = [](const Vector10& v) { return std::vector<double>(v.begin(), v.end()); };
  return {{"truth", list(truth.values)}, {"found", list(found.values)}};
}

void show(Demo& demo, const std::string& heading, const Table& table) {
  if (!demo.json) fmt::print("\n{}\n", heading);
  for (const auto& row : table) {
    if (demo.json) break;
    fmt::print("  {:<18}{:<8}{:>12}{:>12}{:>12}\n", row[0], row[1], row[2], row[3], row[4]);
  }
  demo.page.heading(heading);
  demo.page.table(table);
}

void say(Demo& demo, const std::string& text) {
  if (!demo.json) fmt::print("{}\n", text);
  demo.page.paragraph(text);
}

std::string residual_sentence(const Result& result, const Robot& robot) {
  const Comparison& c = result.heldout;
  return fmt::format(
      "On {} samples that were not fitted the joints' residual torque, after the part that contact "
      "forces can explain is removed, is {:.3g} {} (given model {:.3g}, predicting zero {:.3g}).",
      c.samples, overall(c.found, robot), joints_unit(robot), overall(c.given, robot),
      overall(c.zero, robot));
}

void base_link(Demo& demo) {
  const MotionInputs inputs = record_log(demo, "trot.csv.gz", std::nullopt);
  const RobotInputs robot = read_robot(inputs);
  const BodyModel model = read_shapes_yaml(bundled("quadruped.shapes.yaml"), robot.robot);
  const InertialParameters truth = robot.robot.links.front().inertia;
  RunOptions options;
  options.settings.expected_mass = truth.mass();
  options.settings.division.most_divisions = 0;  // as in the paper: the base's shapes are its own
  const Result result = run_identification(robot, model, inputs, options);
  show(demo,
       fmt::format("The base link: {} shapes of unknown mass, {:.0f} s of trot with sensor noise",
                   model.shapes.size(), demo_seconds),
       truth_table(truth, {result.found.Phi.head<10>()}));
  say(demo, residual_sentence(result, robot.robot));
  demo.document["base"] = comparison_json(truth, {result.found.Phi.head<10>()});
}

/// Watches the divisions: how far mass and place are from the truth after each of them.
class Watch {
 public:
  explicit Watch(const Load& load) : load_(load) {}

  void operator()(const reference::DivisionRun& run) {
    if (run.history.empty()) start_ = Clock::now();  // the first solve is done, the rows are in
    const InertialParameters found{run.solution.Phi.head<10>()};
    const std::chrono::duration<double> elapsed = Clock::now() - start_;
    trace.objective.push_back(run.solution.value.total());
    trace.mass_error.push_back(std::abs(found.mass() - load_.mass));
    trace.place_error.push_back((found.centre_of_mass() - load_.centre).norm());
    trace.seconds.push_back(elapsed.count());
  }

  DivisionTrace trace;

 private:
  using Clock = std::chrono::steady_clock;
  Load load_;
  Clock::time_point start_;
};

void unknown_load(Demo& demo) {
  Load load;
  load.centre.head<2>() << 0.11, -0.045;
  const MotionInputs inputs = record_log(demo, "trot_with_load.csv.gz", load);
  const RobotInputs robot = read_robot(inputs);
  const double floor = load.centre.z() - 0.5 * load.sides.z();
  const BodyModel region =
      load_region(robot.robot, 0, {-0.2, -0.1, floor}, {0.2, 0.1, floor + load.sides.z()});
  RunOptions options;
  options.settings.expected_mass = 1.0;
  Watch watch(load);
  const Result result = run_identification(robot, region, inputs, options,
                                           [&](const reference::DivisionRun& run) { watch(run); });
  const reference::DivisionRun& run = result.found.run;
  show(demo,
       fmt::format("An unknown load: {} divisions of a 0.4 x 0.2 m plate on the base",
                   run.history.size()),
       truth_table(inertia_of(load), {run.solution.Phi}));
  say(demo, residual_sentence(result, robot.robot));
  const std::string division = division_picture(run.model, run.solution.m, load.centre);
  const std::string trace = trace_picture(watch.trace);
  demo.pictures = {{"division.svg", division}, {"trace.svg", trace}};
  demo.page.picture(division,
                    "The plate from above after the last division, darker where denser. Cross: the "
                    "block's true centre; circle: centre of the mass that was found.");
  demo.page.picture(trace, "Objective, errors and time against the number of divisions.");
  demo.document["load"] = comparison_json(inertia_of(load), {run.solution.Phi});
}

void run_demo(Demo& demo) {
  check_gnuplot();
  check_folder_writable(demo.folder);
  const OutputFolder folder(demo.folder);
  demo.page.paragraph(
      "A 12-joint quadruped trots in an independent simulator (Simbody) on compliant ground. Its "
      "log holds joint angles, joint torques, the IMU and contact flags, with sensor noise; no "
      "contact forces. From it the base link's inertia is found from nothing but the sizes of its "
      "shapes, and then the mass and the place of a block on its back.");
  base_link(demo);
  unknown_load(demo);
  const std::string report = demo.file("report.html");
  std::vector<OutputFile> files = demo.pictures;
  files.push_back({"report.html", demo.page.html()});
  folder.write(files);
  demo.document["report"] = report;
  if (demo.json) {
    fmt::print("{}\n", json_text(demo.document, 2));
  } else {
    fmt::print("\nopen {}\n", report);
  }
}

}  // namespace

void add_demo(CLI::App& app) {
  const auto demo = std::make_shared<Demo>();
  demo->folder = "out/demo";
  CLI::App* verb = app.add_subcommand("demo", "the whole story on bundled data, under a minute");
  verb->add_option("--out", demo->folder, "folder for logs, results and the report")
      ->capture_default_str();
  verb->add_flag("--json", demo->json, "print truth and found parameters as JSON");
  verb->callback([demo] { run_demo(*demo); });
}

}  // namespace shapeid::app
