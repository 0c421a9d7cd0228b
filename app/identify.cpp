// shapeid identify: masses, parameters and a URDF from a robot and a log.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "shapeid/app/coarseness.hpp"
#include "shapeid/app/identification.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/sought.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/online_numbers.hpp"
#include "shapeid/reference/online.hpp"

namespace shapeid::app {
namespace {

struct IdentifyArguments {
  MotionInputs inputs;
  RunOptions run;
  Delivery delivery;
  SoughtLinks sought;
  bool online = false;
  double alpha = 0.5;
  std::size_t window = 10, stride = 10;
};

void identify_windows(const IdentifyArguments& options, const RobotInputs& robot,
                      const BodyModel& model, double mass) {
  say_warnings(robot);
  reference::OnlineSettings settings;
  MotionInputs inputs = options.inputs;
  inputs.causal = true;
  LogSamples log(inputs.log, robot, inputs);
  settings.contacts = log.contacts();
  settings.weight = weight(robot);
  settings.window = options.window;
  settings.stride = options.stride;
  settings.alpha = options.alpha;
  settings.expected_mass = mass;
  settings.lambda = options.run.settings.lambda;
  reference::OnlineIdentifier identifier(robot.robot, model, settings);
  std::size_t windows = 0;
  while (const std::optional<Sample> sample = log.next()) {
    const auto result = identifier.feed(*sample);
    if (!result) continue;
    ++windows;
    const Eigen::VectorXd& Phi = result->solution.Phi;
    const nlohmann::json line = {
        {"time", result->time},
        {"objective", result->solution.value.total()},
        {"parameters", std::vector<double>(Phi.begin(), Phi.end())},
        {"filtered", std::vector<double>(result->filtered.begin(), result->filtered.end())}};
    fmt::print("{}\n", line.dump());
  }
  if (windows == 0) {
    throw NotedRefusal(
        Refusal("too-short",
                fmt::format("the log has {} samples, and the first answer needs {}",
                            log.report().samples, std::max(options.window, options.stride))),
        log.report().notes);
  }
  tell(fmt::format("smoothed forward in time; group delay {:.1f} ms\n",
                   1e3 * log.report().group_delay));
}

void identify(IdentifyArguments& options) {
  check_delivery(options.delivery);
  RobotInputs robot = read_robot(options.inputs);
  const BodyModel model = sought_bodies(options.sought, robot);
  warn_of_unused_masses(model.free_links, robot);
  const double mass = expected_mass(options.sought, robot, model);
  if (options.online) return identify_windows(options, robot, model, mass);

  options.run.settings.expected_mass = mass;
  check_test_log(robot, options.inputs, options.run);
  Result result = run_identification(robot, model, options.inputs, options.run);
  with_notes([&] { return robot.notes_with(result.motion); },
             [&] { check_some_mass(result, mass); });
  const Judgement judged = judge(result);
  const std::optional<double>& floor = judged.certified.proof.floor;
  note_coarse_shapes(result, robot.robot, floor);
  deliver(options.delivery, result_json(result, floor, robot.robot),
          result_text(result, floor, robot.robot), result, judged, robot, options.inputs);
}

}  // namespace

void add_identify(CLI::App& app) {
  const auto options = std::make_shared<IdentifyArguments>();
  CLI::App* verb = app.add_subcommand("identify", "masses, parameters and a URDF from a log");
  options->inputs.add_to(*verb);
  options->inputs.add_row_cutoff_to(*verb);
  add_solver_options(*verb, options->run);
  add_hold_out_option(*verb, options->inputs);
  options->sought.add_to(*verb);
  verb->add_option("--effects", options->run.effects,
                   "effects.yaml of diagnose: friction and the like, taken as known");
  verb->add_option("--min-mass", options->run.least_mass,
                   "kg: a link found lighter is written with this mass, its given inertia scaled")
      ->check(zero_or_above())
      ->capture_default_str();
  add_delivery_options(*verb, options->delivery);
  CLI::Option* online = verb->add_flag(
      "--online", options->online,
      "a JSON line per window, as on the robot: smoothed forward in time, filter (17), no "
      "divisions");
  verb->add_option("--window", options->window, "samples a window (--online)")
      ->check(count_from(1, longest_window))
      ->needs(online)
      ->capture_default_str();
  verb->add_option("--stride", options->stride, "samples from window to window (--online)")
      ->check(count_from(1, longest_window))
      ->needs(online)
      ->capture_default_str();
  verb->add_option("--alpha", options->alpha, "filter (17) (--online)")
      ->check(share_above_zero())
      ->needs(online)
      ->capture_default_str();
  // Windows are answered one by one, undivided and on standard output.
  for (const char* other : {"--out", "--json", "--test", "--effects", "--min-mass", "--row-cutoff",
                            "--hold-out", "--divisions", "--k1", "--k2", "--eps"}) {
    online->excludes(verb->get_option(other));
  }
  verb->callback([options] { identify(*options); });
}

}  // namespace shapeid::app
