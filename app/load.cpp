// shapeid load: mass and place of an unknown load on a link, every link's inertia being known.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "shapeid/app/coarseness.hpp"
#include "shapeid/app/identification.hpp"
#include "shapeid/app/load_text.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/number.hpp"
#include "shapeid/models/robot_size.hpp"
#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid::app {
namespace {

struct LoadArguments {
  MotionInputs inputs;
  RunOptions run;
  std::vector<std::string> area;
  Delivery delivery;
  double expected_mass = 0.0;
};

double bound(const std::string& text) {
  if (const std::optional<double> value = parse_number(text)) return *value;
  throw InputError("--area " + why_no_number(text), "LINK x0 x1 y0 y1 z0 z1, in m");
}

BodyModel region(const LoadArguments& options, const Robot& robot) {
  const auto site = robot.find_site(options.area.front());
  if (!site) throw InputError("--area: no link " + options.area.front(), "a link of the URDF");
  Eigen::Vector3d lower, upper;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t at = 1 + 2 * static_cast<std::size_t>(axis);
    lower[axis] = bound(options.area[at]);
    upper[axis] = bound(options.area[at + 1]);
    if (!(lower[axis] < upper[axis])) {
      throw InputError(fmt::format("--area: {} to {} is empty", lower[axis], upper[axis]),
                       "the lower bound first, the larger one after it");
    }
  }
  const double furthest = lower.cwiseAbs().cwiseMax(upper.cwiseAbs()).norm();
  if (const auto why = why_too_far(furthest, robot)) {
    throw InputError("--area: a corner is " + *why, "metres, in the link's frame");
  }
  return load_region(robot, site->link, lower, upper, site->pose);
}

/// As asked for, else the middle of what robot.yaml says of loads, else a kilogram.
double mass_of_load(const LoadArguments& options, const RobotNotes& notes) {
  if (options.expected_mass > 0.0) return options.expected_mass;
  const auto range = notes.expected_mass.find("load");
  if (range == notes.expected_mass.end()) return 1.0;
  return 0.5 * (range->second.lower + range->second.upper);
}

/// Signals are filtered less, and rows of the equations as signals were: a filter bends the motion
/// where products of its parts count, and rows that are filtered it does not bend. Empty where
/// there is no other filter, or nothing is found behind it.
std::optional<LoadElsewhere> behind_other_filter(const LoadArguments& options,
                                                 const RobotInputs& robot, const BodyModel& model,
                                                 double rate) {
  constexpr double times = 4.0, highest = 0.4;  // of the rate
  MotionInputs inputs = options.inputs;
  if (inputs.exact || inputs.cutoff == 0.0 || inputs.row_cutoff > 0.0) return std::nullopt;
  inputs.row_cutoff = inputs.cutoff;
  inputs.cutoff = std::min(times * inputs.cutoff, highest * rate);
  if (!(inputs.cutoff > inputs.row_cutoff)) return std::nullopt;
  try {
    const Result result = run_identification(robot, model, inputs, options.run);
    return LoadElsewhere{inputs.cutoff, inputs.row_cutoff, result.found.run.solution.Phi[0],
                         result.found.standard_error[0]};
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

void load(LoadArguments& options) {
  check_delivery(options.delivery);
  const RobotInputs robot = read_robot(options.inputs);
  const BodyModel model = region(options, robot.robot);
  options.run.settings.expected_mass = mass_of_load(options, robot.notes);
  check_test_log(robot, options.inputs, options.run);
  Result result = run_identification(robot, model, options.inputs, options.run);
  with_notes([&] { return result.notes; }, [&] { check_some_weight(result, robot.robot); });
  const auto other = behind_other_filter(options, robot, model, result.motion.rate);
  for (std::string& note : load_notes(result, robot, options.run.settings.expected_mass)) {
    result.notes.push_back(std::move(note));
  }
  const std::string note = other ? filter_note(result, *other) : std::string();
  if (!note.empty()) result.notes.push_back(note);
  const Judgement judged = judge(result);
  const std::optional<double>& floor = judged.certified.proof.floor;
  note_coarse_shapes(result, robot.robot, floor);
  nlohmann::json document = result_json(result, floor, robot.robot);
  document["load"] = load_json(result, robot.robot, other);
  deliver(options.delivery, document,
          result_text(result, floor, robot.robot) + load_text(result, robot.robot), result, judged,
          robot, options.inputs);
}

}  // namespace

void add_load(CLI::App& app) {
  const auto options = std::make_shared<LoadArguments>();
  CLI::App* verb = app.add_subcommand("load", "an unknown load on a link: its mass and its place");
  options->inputs.add_to(*verb);
  options->inputs.add_row_cutoff_to(*verb);
  add_solver_options(*verb, options->run);
  add_hold_out_option(*verb, options->inputs);
  verb->add_option("--area", options->area,
                   "LINK x0 x1 y0 y1 z0 z1: where the load may be, m, in the link's frame")
      ->required()
      ->expected(7);
  verb->add_option("--expected-mass", options->expected_mass,
                   "kg, roughly: it scales the criterion (default: the middle of \"load\" in "
                   "robot.yaml, else 1)")
      ->check(mass_of_a_robot());
  add_delivery_options(*verb, options->delivery);
  verb->callback([options] { load(*options); });
}

}  // namespace shapeid::app
