// shapeid diagnose: what the model lacks, and a richer one.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <thread>
#include <utility>

#include "shapeid/app/diagnosis_report.hpp"
#include "shapeid/app/diagnosis_result.hpp"
#include "shapeid/app/gnuplot.hpp"
#include "shapeid/app/identification.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/output_folder.hpp"
#include "shapeid/app/sought.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/effects_yaml.hpp"
#include "shapeid/diagnosis/torque_header.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

struct DiagnoseArguments {
  DiagnoseOptions diagnose;
  Delivery delivery;
  bool strict = false;
};

void write_files(const DiagnoseArguments& options, const RobotInputs& robot, DiagnosisRun& run) {
  const Robot& r = robot.robot;
  std::string urdf = diagnosed_urdf(run, r, options.diagnose.inputs.robot);
  diagnosis::RichModel model = run.consistent.model;
  if (options.diagnose.curves) model.curves = run.curves;
  OutputFolder(options.delivery.folder)
      .write({{"identified.urdf", std::move(urdf)},
              {"effects.yaml", diagnosis::write_effects_yaml(r, {model.acting(), model.curves})},
              {"predict_torque.hpp", diagnosis::torque_header(r, model)},
              {"result.json", json_text(diagnosis_json(run, r, options.diagnose), 2) + "\n"},
              {"report.html", diagnosis_report(run, r, options.diagnose)}});
}

void diagnose(DiagnoseArguments& options) {
  check_delivery(options.delivery);
  if (!options.delivery.folder.empty()) check_gnuplot();
  DiagnoseOptions& d = options.diagnose;
  if (d.inputs.exact) d.inputs.cutoff = 0.0;  // nothing is smoothed
  for (const auto& logs : {d.also, d.test}) {
    for (const std::string& log : logs) check_no_stream(log);
  }
  check_no_stream(d.reference);
  const RobotInputs robot = read_robot(d.inputs);
  DiagnosisRun run = with_notes([&] { return robot.all_notes(); },
                                [&] { return run_diagnosis(robot, options.diagnose); });
  const std::string unused = unused_masses(run.settings.shapes.free_links, robot);
  if (!unused.empty()) run.notes.push_back(unused);
  if (!options.delivery.folder.empty()) write_files(options, robot, run);
  if (options.delivery.json) {
    fmt::print("{}\n", json_text(diagnosis_json(run, robot.robot, options.diagnose), 2));
  } else {
    fmt::print("{}", diagnosis_text(run, robot.robot));
  }
  if (options.strict && !run.structures.empty()) {
    throw Refusal("unexplained",
                  fmt::format("the residual of {} follows {}, and no effect explains "
                              "it (--strict)",
                              run.structures.front().joint, run.structures.front().variable));
  }
}

/// The catalogue needs neither robot nor log: it is printed before any is asked for.
void print_catalogue(const CLI::App& verb) {
  const auto others = verb.get_options([](const CLI::Option* option) {
    return option->count() > 0 && !option->check_name("--list");
  });
  if (!others.empty() || verb.remaining_size() > 0) {
    throw CLI::ValidationError("--list", "stands alone: leave everything else out");
  }
  fmt::print("{}", diagnosis::catalogue_page());
  throw CLI::Success();
}

}  // namespace

void add_diagnose(CLI::App& app) {
  const auto options = std::make_shared<DiagnoseArguments>();
  DiagnoseOptions& d = options->diagnose;
  CLI::App* verb =
      app.add_subcommand("diagnose", "what the model lacks: effects, their sizes, a richer model");
  verb->add_flag_callback(
      "--list", [verb] { print_catalogue(*verb); }, "print the effects that can be found");
  d.inputs.add_to(*verb);
  add_delivery_options(*verb, options->delivery);
  verb->add_option("--also", d.also, "further logs of this robot, fitted together with the first");
  verb->add_option("--test", d.test,
                   "logs for the final comparison (default: every fifth two seconds of the log)");
  add_hold_out_option(*verb, d.inputs);
  verb->add_option("--reference", d.reference,
                   "earlier log of the same robot: what has come or gone since is then a finding");
  auto* shapes = verb->add_option(
      "--shapes", d.shapes, "shapes.yaml (default: a grid of 216 cells about each sought link)");
  auto* named = verb->add_option("--free", d.free_links,
                                 "links of unknown inertia (default: the floating base, or all "
                                 "links of a fixed one)");
  auto* whole = verb->add_flag("--whole-body", d.whole_body, "the inertia of no link is known");
  auto* trust = verb->add_flag("--trust", d.trust, "the given inertias are right");
  named->excludes(shapes)->excludes(whole)->excludes(trust);
  trust->excludes(shapes)->excludes(whole);
  whole->excludes(shapes);
  verb->add_option("--expected-mass", d.expected_mass,
                   "kg, of all sought links (default: as given)")
      ->check(mass_of_a_robot())
      ->excludes(trust);
  verb->add_option("--least-t", d.rule.least_t,
                   "standard errors by which an effect must lower the held-out error")
      ->check(above_zero())
      ->capture_default_str();
  verb->add_option_function<std::string>(
          "--path",
          [options](const std::string& name) {
            options->diagnose.path =
                name == "fast" ? diagnosis::Path::fast : diagnosis::Path::reference;
          },
          "who computes rows and masses")
      ->check(CLI::IsMember({"reference", "fast"}))
      ->default_str("reference");
  // Each has sums of its own: of a quadruped's hypotheses some tens of megabytes.
  constexpr unsigned most_threads = 8;
  d.threads = std::clamp(std::thread::hardware_concurrency(), 1U, most_threads);
  verb->add_option("--threads", d.threads,
                   "that go over logs and hypotheses; no number depends on it")
      ->check(count_from(1))
      ->capture_default_str();
  verb->add_flag("--curves", d.curves,
                 "write effects.yaml and predict_torque.hpp with curves for what stays unexplained")
      ->needs(verb->get_option("--out"));
  verb->add_flag("--strict", options->strict, "exit status 1 if structure stays unexplained");
  verb->callback([options] { diagnose(*options); });
}

}  // namespace shapeid::app
