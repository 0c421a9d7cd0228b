#include "shapeid/app/identification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "shapeid/app/certificate_text.hpp"
#include "shapeid/app/json_text.hpp"
#include "shapeid/app/limit.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/number_source.hpp"
#include "shapeid/app/option_checks.hpp"
#include "shapeid/app/output_folder.hpp"
#include "shapeid/app/recordings.hpp"
#include "shapeid/app/shared_stretches.hpp"
#include "shapeid/app/tell.hpp"
#include "shapeid/diagnosis/effects_yaml.hpp"
#include "shapeid/diagnosis/motion_noise.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/proofs/certificate/certificate_json.hpp"
#include "shapeid/reference/residual.hpp"

namespace shapeid::app {
namespace {

/// Samples of one part of the log (or all of it, when another log is for testing).
class PartOfLog {
 public:
  PartOfLog(LogSamples& log, const MotionInputs& inputs, std::optional<Part> wanted)
      : log_(&log), inputs_(&inputs), wanted_(wanted) {}

  std::optional<Sample> next() {
    while (std::optional<Sample> sample = log_->next()) {
      if (!started_) start_ = sample->time;
      started_ = true;
      if (!wanted_ || part_of(sample->time - start_, *inputs_) == *wanted_) return sample;
    }
    return std::nullopt;
  }

 private:
  LogSamples* log_;
  const MotionInputs* inputs_;
  std::optional<Part> wanted_;
  bool started_ = false;
  double start_ = 0.0;
};

Comparison compare(const RobotInputs& robot, const MotionInputs& inputs, const RunOptions& options,
                   const Eigen::VectorXd& found) {
  const bool same_log = options.test_log.empty();
  LogSamples log(same_log ? inputs.log : options.test_log, robot, inputs);
  PartOfLog samples(log, inputs, same_log ? std::optional(Part::held_out) : std::nullopt);
  const Eigen::VectorXd given = stacked_parameters(robot.robot);
  reference::ResidualTable table(robot.robot, log.contacts(),
                                 {Eigen::VectorXd::Zero(given.size()), given, found});
  while (const std::optional<Sample> sample = samples.next()) table.add(*sample);
  const Eigen::MatrixXd rms = table.rms();
  return {table.samples(), rms.col(0), rms.col(1), rms.col(2),
          same_log ? held_out_words(inputs) : options.test_log};
}

diagnosis::RichModel known_model(const Robot& robot, const std::string& effects_file) {
  diagnosis::KnownEffects known = diagnosis::read_effects_yaml(effects_file, robot);
  return {stacked_parameters(robot), std::move(known.effects), std::move(known.curves)};
}

/// Rigid links and known effects over a log in memory: effects look at neighbouring samples.
class EffectsRun {
 public:
  EffectsRun(const RobotInputs& robot, const MotionInputs& inputs, const RunOptions& options)
      : robot_(&robot.robot),
        model_(known_model(robot.robot, options.effects)),
        log_(read_recording(inputs.log, robot, inputs,
                            options.test_log.empty() ? std::optional(Part::fitted) : std::nullopt)),
        viewer_(robot.robot, log_.contacts, model_.effects),
        usable_(log_.recording.usable(1)) {}

  [[nodiscard]] const RecordedLog& log() const { return log_; }

  std::optional<Sample> next() {
    if (next_ == usable_.size()) return std::nullopt;
    return viewer_.moved(log_.recording, usable_[next_++]);
  }

  [[nodiscard]] reference::SampleRows rows(const Sample& moved, const BodyModel& bodies) const {
    diagnosis::RichModel known = model_;
    known.Phi = bodies.known;
    for (const int link : bodies.free_links) {
      // Where an effect needs the load before the masses are known, the given ones predict it.
      const Eigen::Index at = Eigen::Index{10} * link;
      known.Phi.segment<10>(at) = model_.Phi.segment<10>(at);
    }
    const std::vector<Sample>& samples = log_.recording.samples();
    const auto place =
        std::lower_bound(samples.begin(), samples.end(), moved.time,
                         [](const Sample& sample, double time) { return sample.time < time; });
    const auto index = static_cast<std::size_t>(place - samples.begin());
    const diagnosis::View view = viewer_.view(log_.recording, index);
    reference::SampleRows rows = mass_rows(viewer_, view, known, bodies.free_links);
    // As in the errors beside the answer: friction at rest holds any torque.
    const auto counted = counted_rows(viewer_, log_.recording, index, view);
    for (Eigen::Index row = 0; row < counted.size(); ++row) {
      if (counted[row]) continue;
      rows.Y.row(row).setZero();
      rows.F[row] = 0.0;
    }
    return rows;
  }

  [[nodiscard]] Comparison compare(const RobotInputs& robot, const MotionInputs& inputs,
                                   const RunOptions& options, const Eigen::VectorXd& found) const {
    const bool same_log = options.test_log.empty();
    const RecordedLog test =
        read_recording(same_log ? inputs.log : options.test_log, robot, inputs,
                       same_log ? std::optional(Part::held_out) : std::nullopt);
    const auto rms = [&](const diagnosis::RichModel& model) -> Eigen::VectorXd {
      return diagnosis::series(*robot_, test.contacts, model, test.recording, 1).rms();
    };
    return {test.recording.usable(1).size(), rms({Eigen::VectorXd::Zero(found.size()), {}}),
            rms({model_.Phi, {}}), rms({found, model_.effects, model_.curves}),
            same_log ? held_out_words(inputs) : options.test_log};
  }

 private:
  const Robot* robot_;
  diagnosis::RichModel model_;
  RecordedLog log_;
  diagnosis::Viewer viewer_;
  std::vector<std::size_t> usable_;
  std::size_t next_ = 0;
};

}  // namespace

void check_solver(const reference::IdentifySettings& settings) {
  if (settings.division.k1 == 0.0 && settings.division.k2 == 0.0) {
    throw InputError("--k1 and --k2 are both 0", "one above 0: they say which shape is divided");
  }
}

reference::IdentifySettings settings_for(const LogSamples& log, const RobotInputs& robot,
                                         const MotionInputs& inputs,
                                         reference::IdentifySettings settings) {
  settings.contacts = log.contacts();
  settings.floor = floor_of_divisions;
  if (settings.weight.size() == 0) settings.weight = weight(robot);
  if (inputs.row_cutoff > 0.0) {
    check_cutoff("--row-cutoff", inputs.row_cutoff, log.report().rate);
    settings.row_filter.emplace();
    settings.row_filter->cutoff = inputs.row_cutoff;
    settings.row_filter->rate = log.report().rate;
  }
  // Signals behind it would bend a fast motion; rows do not, and need no second reading of the log.
  MotionInputs slower = inputs;
  slower.cutoff = slower_cutoff(inputs);
  if (slower.cutoff > 0.0) {
    settings.slower.emplace();
    settings.slower->cutoff = slower.cutoff;
    settings.slower->rate = log.report().rate;
    settings.slower->keep_every = static_cast<int>(stride_of(slower, log.report().rate));
  }
  return settings;
}

double slower_cutoff(const MotionInputs& inputs) {
  const double of_signals = inputs.exact ? 0.0 : inputs.cutoff;
  const double of_rows = inputs.row_cutoff > 0.0 ? inputs.row_cutoff : of_signals;
  // Signals that end below the filter of the rows would pass half of that unchanged.
  return diagnosis::slower_by * (of_signals > 0.0 ? std::min(of_rows, of_signals) : of_rows);
}

void check_test_log(const RobotInputs& robot, const MotionInputs& inputs,
                    const RunOptions& options) {
  check_no_stream(options.test_log);
  if (options.test_log.empty()) return;
  refuse_same_data({{inputs.log}, {}, {options.test_log}}, robot.mapping);
}

Result run_identification(const RobotInputs& robot, const BodyModel& model,
                          const MotionInputs& inputs, const RunOptions& options,
                          const std::function<void(const reference::DivisionRun&)>& watch) {
  check_solver(options.settings);
  std::optional<EffectsRun> effects;
  if (!options.effects.empty()) effects.emplace(robot, inputs, options);
  LogSamples log(inputs.log, robot, inputs);
  PartOfLog samples(log, inputs,
                    options.test_log.empty() ? std::optional(Part::fitted) : std::nullopt);
  if (!options.test_log.empty()) {
    const LogSamples test(options.test_log, robot, inputs);
    check_contacts_alike({inputs.log, log.report().contacts_derived},
                         {options.test_log, test.report().contacts_derived}, log.contacts());
  }
  reference::IdentifySettings settings = settings_for(log, robot, inputs, options.settings);
  if (effects) {
    settings.rows = [&](const Sample& moved) { return effects->rows(moved, model); };
  }

  const auto next = [&] { return effects ? effects->next() : samples.next(); };
  bool is_any_fitted = false;
  const reference::SampleStream noticed = [&] {
    std::optional<Sample> sample = next();
    is_any_fitted = is_any_fitted || sample.has_value();
    return sample;
  };

  Result result;
  result.robot_file = inputs.robot;
  result.robot_yaml_file = robot.robot_yaml;
  result.log_file = inputs.log;
  result.sought = model;
  const auto read = [&]() -> const MotionReport& {
    return effects ? effects->log().motion : log.report();
  };
  const auto find = [&] {
    try {
      result.found = identify(robot.robot, model, noticed, settings, watch);
    } catch (const Refusal& refusal) {
      if (refusal.code() != "no-data" || is_any_fitted) throw;
      // A stretch of the log alone is fitted: that it holds nothing is no fault of the samples.
      refuse_without_samples(read());
      if (options.test_log.empty()) refuse_all_held_out(read().samples);
      throw;
    }
  };
  with_notes([&] { return robot.notes_with(read()); }, find);
  result.motion = read();
  result.slower_cutoff = slower_cutoff(inputs);
  result.notes = robot.notes_with(result.motion);
  note_numbers_that_hang(result);
  choose_written_links(result, robot.robot, options.least_mass);
  result.heldout =
      with_notes([&] { return robot.notes_with(result.motion); },
                 [&] {
                   return effects ? effects->compare(robot, inputs, options, result.found.Phi)
                                  : compare(robot, inputs, options, result.found.Phi);
                 });
  if (result.sought.free_links.size() < moving_links(robot.robot).size()) {
    result.notes.emplace_back(
        "standard errors are of the scatter between blocks of time: what is taken as given (other "
        "links, friction, the scale of torques) is in none of them; diagnose looks for it");
  }
  return result;
}

void deliver(const Delivery& delivery, nlohmann::json document, const std::string& text,
             const Result& result, const Judgement& judged, const RobotInputs& robot,
             const MotionInputs& inputs) {
  const std::vector<std::string>& reasons = judged.certified.reasons;
  if (!reasons.empty()) {
    throw std::logic_error("the exact checker rejects this answer: " + reasons.front());
  }
  document["certificate"] = {
      {"accepted", reasons.empty()}, {"gap", judged.certified.proof.gap}, {"reasons", reasons}};
  const std::string json = json_text(document, 2) + "\n";
  std::vector<OutputFile> files;
  if (!delivery.folder.empty()) {
    files = {{"result.json", json},
             {"problem.json", problem_to_json(judged.problem)},
             {"answer.json", answer_to_json(judged.answer)},
             {"certificate.json", certificate_to_json(judged.certified.proof, judged.evidence)},
             {"identified.urdf", write_urdf(inputs.robot, robot.robot, result.written)}};
  }
  fmt::print("{}", delivery.json ? json : text);
  if (!delivery.folder.empty()) {
    OutputFolder(delivery.folder).write(files);
    tell(fmt::format("{}", certified_text(judged.certified)));
  }
}

void check_delivery(const Delivery& delivery) {
  if (!delivery.folder.empty()) check_folder_writable(delivery.folder);
}

void add_delivery_options(CLI::App& verb, Delivery& delivery) {
  verb.add_option("--out", delivery.folder, "folder for result.json, identified.urdf and more");
  verb.add_flag("--json", delivery.json, "print the result as JSON");
}

void add_solver_options(CLI::App& verb, RunOptions& options) {
  verb.add_option("--test", options.test_log,
                  "log to measure the residual on (default: every fifth two seconds are held out)");
  add_solver_options(verb, options.settings);
}

void add_solver_options(CLI::App& verb, reference::IdentifySettings& settings) {
  DivisionOptions& division = settings.division;
  verb.add_option("--divisions", division.most_divisions, "most divisions; 0 does not divide")
      ->check(count_from(0, std::numeric_limits<int>::max()))
      ->capture_default_str();
  verb.add_option("--k1", division.k1, "equation (16): weight of large heavy shapes")
      ->check(weight_of_criterion())
      ->capture_default_str();
  verb.add_option("--k2", division.k2, "equation (16): weight of dense shapes")
      ->check(weight_of_criterion())
      ->capture_default_str();
  verb.add_option("--eps", division.step,
                  "stop when divisions change Phi by less, relatively, and no "
                  "plateau holds them far above the floor; 0: never")
      ->check(zero_or_above())
      ->capture_default_str();
  verb.add_option("--lambda", settings.lambda,
                  "weight of the density term (default: docs/derivations/mass-problem.md)")
      ->check(zero_or_above());
}

}  // namespace shapeid::app
