// shapeid batch: one answer from many logs, read on several threads or machines.
#include "shapeid/app/batch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "shapeid/app/coarseness.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/shared_stretches.hpp"
#include "shapeid/app/verbs.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

using nlohmann::json;

/// The robot, whose root and default contacts depend on a log's header: the first that can be read.
RobotInputs read_robot_with_any(MotionInputs inputs, const std::vector<std::string>& logs) {
  std::optional<InputError> first;
  for (const std::string& log : logs) {
    try {
      inputs.log = log;
      return read_robot(inputs);
    } catch (const InputError& e) {
      if (!first) first = e;
    }
  }
  throw InputError(*first);
}

json logs_json(const std::vector<BatchLog>& logs) {
  json list = json::array();
  for (const BatchLog& log : logs) {
    const bool used = log.refused.empty();
    list.push_back({{"log", log.path},
                    {"refused", used ? json() : json(log.refused)},
                    {"rows", log.rows},
                    {"samples", used ? log.samples : 0},
                    {"gaps", log.gaps},
                    {"residual", used ? json(log.residual) : json()}});
  }
  return list;
}

std::string logs_text(const std::vector<BatchLog>& logs) {
  std::string text = fmt::format("{:>10}{:>10}{:>12}  log\n", "rows", "samples", "residual");
  for (const BatchLog& log : logs) {
    if (log.refused.empty()) {
      text +=
          fmt::format("{:>10}{:>10}{:>12.5g}  {}\n", log.rows, log.samples, log.residual, log.path);
    } else {
      text += fmt::format("{:>32}  {}: {}\n", "refused", log.path, log.refused);
    }
  }
  return text + "\n";
}

}  // namespace

void BatchOptions::add_to(CLI::App& verb) {
  inputs.quiet = true;
  threads = std::max(1U, std::thread::hardware_concurrency());
  inputs.add_robot_to(verb);
  verb.add_option("--log", logs, "logs, CSV or CSV.gz; the order counts, to the last bit")
      ->required();
  inputs.add_smoothing_to(verb);
  inputs.add_row_cutoff_to(verb);
  add_solver_options(verb, settings);
  sought.add_to(verb);
  verb.add_option("--min-mass", least_mass,
                  "kg: a link found lighter is written with this mass, its given inertia scaled")
      ->check(zero_or_above())
      ->capture_default_str();
  verb.add_option("--threads", threads, "logs that are read at once, by each process")
      ->check(count_from(1))
      ->capture_default_str();
  verb.add_option("--blocks", most_blocks,
                  "most blocks of neighbouring logs, by whose spread errors are judged")
      ->check(count_from(2, reference::most_blocks))
      ->capture_default_str();
  verb.add_flag("--skip-refused", skip_refused, "go on without logs that cannot be used");
  add_delivery_options(verb, delivery);
}

void batch(const BatchOptions& options, Peers& peers) {
  // Only number 0 writes, and the others may be on machines that do not have the folder.
  if (peers.rank() == 0) check_delivery(options.delivery);
  for (const std::string& log : options.logs) check_no_stream(log);
  check_solver(options.settings);
  RobotInputs robot = read_robot_with_any(options.inputs, options.logs);
  // The same measurements twice would say that the answer is twice as sure. One process looks.
  if (peers.rank() == 0) refuse_same_data({options.logs}, robot.mapping, options.threads);
  const BodyModel model = sought_bodies(options.sought, robot);
  warn_of_unused_masses(model.free_links, robot);
  BatchOptions with_mass = options;
  with_mass.settings.expected_mass = expected_mass(options.sought, robot, model);
  std::optional<BatchResult> found = run_batch(with_mass, robot, model, peers);
  if (!found) return;
  const Judgement judged = judge(found->result);
  const std::optional<double>& floor = judged.certified.proof.floor;
  note_coarse_shapes(found->result, robot.robot, floor);
  json document = result_json(found->result, floor, robot.robot);
  document["logs"] = logs_json(found->logs);
  deliver(options.delivery, document,
          logs_text(found->logs) + result_text(found->result, floor, robot.robot), found->result,
          judged, robot, options.inputs);
}

void add_batch(CLI::App& app) {
  const auto options = std::make_shared<BatchOptions>();
  CLI::App* verb = app.add_subcommand("batch", "one answer from many logs, read in parallel");
  options->add_to(*verb);
  verb->callback([options] {
    Alone alone;
    batch(*options, alone);
  });
}

}  // namespace shapeid::app
