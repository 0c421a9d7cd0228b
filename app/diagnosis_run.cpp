#include "shapeid/app/diagnosis_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "shapeid/app/diagnosis_logs.hpp"
#include "shapeid/app/motion_noise.hpp"
#include "shapeid/app/no_mass.hpp"
#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/result.hpp"
#include "shapeid/diagnosis/contact_reach.hpp"
#include "shapeid/diagnosis/contacts_in_loop.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/diagnosis/needed.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/diagnosis/same_time.hpp"
#include "shapeid/diagnosis/slowness.hpp"
#include "shapeid/diagnosis/torque_noise.hpp"
#include "shapeid/diagnosis/usual.hpp"
#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid::app {
namespace {

using diagnosis::Recording;

std::vector<int> free_links(const DiagnoseOptions& options, const Robot& robot) {
  if (options.trust) return {};
  if (!options.free_links.empty()) return named_links(options.free_links, robot);
  if (robot.root == Root::floating && !options.whole_body) return {0};
  return moving_links(robot);
}

BodyModel body_model(const DiagnoseOptions& options, const Robot& robot) {
  if (!options.shapes.empty()) return read_shapes_yaml(options.shapes, robot);
  const std::vector<int> links = free_links(options, robot);
  if (!links.empty()) return diagnosis::generous_regions(robot, links);
  BodyModel known;
  known.known = stacked_parameters(robot);
  return known;
}

double expected_mass(const DiagnoseOptions& options, const RobotInputs& inputs,
                     const BodyModel& model) {
  if (options.expected_mass > 0.0) return options.expected_mass;
  const double mass = shapeid::expected_mass(inputs.robot, inputs.notes, model.free_links);
  if (!(mass > 0.0) && !model.free_links.empty()) {
    throw InputError("the free links have no mass in the URDF",
                     "give --expected-mass, or expected_mass in robot.yaml");
  }
  return mass;
}

diagnosis::LoopSettings settings_for(const RobotInputs& inputs, const DiagnoseOptions& options,
                                     const RecordedLog& log) {
  const Robot& robot = inputs.robot;
  diagnosis::LoopSettings settings;
  settings.rows = {log.contacts, options.path};
  settings.shapes = body_model(options, robot);
  settings.expected_mass = expected_mass(options, inputs, settings.shapes);
  settings.weight = weight(inputs);
  settings.rule = options.rule;
  settings.log_starts = log.starts;
  settings.threads = options.threads;
  settings.size = Eigen::VectorXd::Ones(Eigen::Index{10} * robot.link_count());
  const auto& links = settings.shapes.free_links;
  if (!links.empty()) {
    const auto count = static_cast<Eigen::Index>(links.size());
    const Eigen::VectorXd sizes = reference::sizes_of_links(
        settings.shapes,
        Eigen::VectorXd::Constant(count, settings.expected_mass) / static_cast<double>(count));
    for (std::size_t i = 0; i < links.size(); ++i) {
      settings.size.segment<10>(Eigen::Index{10} * links[i]) =
          sizes.segment<10>(10 * static_cast<Eigen::Index>(i));
    }
  }
  settings.stride = stride_of(options.inputs, log.motion.rate);
  settings.margin = margin_of(options.inputs, log.motion.rate);
  return settings;
}

/// Logged torque without any filter at the samples of the series; joints x samples. NaN where the
/// unfiltered log has no sample at that time.
Eigen::MatrixXd unfiltered_torque(const Recording& smooth, const diagnosis::Series& series,
                                  const Recording& raw) {
  Eigen::MatrixXd tau = Eigen::MatrixXd::Constant(smooth[0].tau.size(), std::ssize(series.index),
                                                  std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < tau.cols(); ++i) {
    const Sample* at =
        diagnosis::sample_at(raw, smooth[series.index[static_cast<std::size_t>(i)]].time);
    if (at != nullptr) tau.col(i) = at->tau;
  }
  return tau;
}

TestErrors test_errors(const RobotInputs& robot, const DiagnoseOptions& options,
                       const DiagnosisRun& run, const Recording& raw) {
  const auto& settings = run.settings;
  const Robot& r = robot.robot;
  const Eigen::Index n = r.joint_count();
  diagnosis::RichModel nothing{Eigen::VectorXd::Zero(Eigen::Index{10} * r.link_count()), {}};
  const diagnosis::Series zero =
      diagnosis::series(r, settings.rows, nothing, run.test, run.test_stride);
  TestErrors errors;
  errors.where = options.test.empty() ? held_out_words(options.inputs)
                                      : fmt::format("{}", fmt::join(options.test, ", "));
  errors.samples = run.after.index.size();
  errors.at_rest = 1.0 - zero.counted.cast<double>().rowwise().mean();
  errors.zero = zero.rms();
  errors.given = run.before.rms();
  errors.found = run.after.rms();
  const Eigen::MatrixXd tau = unfiltered_torque(run.test, zero, raw);
  Eigen::MatrixXd smooth(n, tau.cols());
  for (Eigen::Index i = 0; i < tau.cols(); ++i) {
    smooth.col(i) = run.test[zero.index[static_cast<std::size_t>(i)]].tau;
  }
  // The part that contact forces explain is the smooth signals' own: only the torque is exchanged.
  const Eigen::MatrixXd rough = tau - smooth;
  const auto counted = zero.counted.bottomRows(n);
  errors.unfiltered_zero = diagnosis::row_rms(zero.residual.bottomRows(n) - rough, counted);
  errors.unfiltered_given = diagnosis::row_rms(run.before.residual.bottomRows(n) - rough, counted);
  errors.unfiltered_found = diagnosis::row_rms(run.after.residual.bottomRows(n) - rough, counted);
  const bool filtered = options.inputs.cutoff > 0.0 && !options.inputs.exact;
  errors.noise_floor = diagnosis::row_rms(rough, counted) *
                       (filtered ? noise_left_over_taken(options.inputs.cutoff, run.test.rate())
                                 : std::numeric_limits<double>::quiet_NaN());
  return errors;
}

/// What was accepted under a name that does not stand, with the curve that it leaves when it is
/// taken out of the model.
std::vector<diagnosis::Structure> unnamed(const Robot& robot, const Recording& log,
                                          const DiagnosisRun& run) {
  std::vector<diagnosis::Structure> list;
  for (const diagnosis::Found& f : run.loop.found) {
    if (!f.varies || !f.effect.acts_in_log()) continue;
    diagnosis::RichModel model = run.consistent.model;
    const auto removed = std::erase_if(
        model.effects, [&](const diagnosis::AppliedEffect& a) { return same_place(a, f.effect); });
    if (removed == 0) continue;
    list.push_back(diagnosis::unnamed(
        robot, log, diagnosis::series(robot, run.settings.rows, model, log, run.settings.stride),
        *f.varies));
    list.back().under_name = f.id;
  }
  return list;
}

void note_rests(const Robot& robot, DiagnosisRun& run) {
  for (int j = 0; j < robot.joint_count(); ++j) {
    const double share = run.errors.at_rest[robot.base_dof() + j];
    if (!(share > 0.0)) continue;
    run.notes.push_back(
        fmt::format("{} stands still in {:.0f} % of the test; its torque does not count there, "
                    "because friction at rest holds any",
                    robot.joint(j).name, 100.0 * share));
  }
}

void note_unsettled_links(const Robot& robot, DiagnosisRun& run) {
  for (const int link : run.settings.shapes.free_links) {
    if (!run.causes_alone) continue;
    const auto moved = diagnosis::hangs_on_descriptions(run.consistent, *run.causes_alone, link);
    if (!moved) continue;
    const Eigen::Index at = Eigen::Index{10} * link + *moved;
    run.notes.push_back(fmt::format(
        "the inertia of {} is not identified: it hangs on effects that are no causes ({} is {:.4g} "
        "{} beside them, {:.4g} without)",
        robot.links[static_cast<std::size_t>(link)].name,
        parameter_names[static_cast<std::size_t>(*moved)], run.consistent.model.Phi[at],
        parameter_units[static_cast<std::size_t>(*moved)], run.causes_alone->model.Phi[at]));
  }
}

void note_mass_beside_forces(const Robot& robot, DiagnosisRun& run) {
  if (!run.loop.mass_beside_forces) return;
  run.notes.push_back(
      fmt::format("{} would have {:.3g} kg, as a free number, beside constant forces that stand "
                  "for its weight; "
                  "accel_noise took their place, "
                  "because the mass then is nearer to the given one: weigh it",
                  robot.links[0].name, *run.loop.mass_beside_forces));
}

void note_far_masses(const Robot& robot, DiagnosisRun& run) {
  const std::vector<int>& free_links = run.settings.shapes.free_links;
  for (std::size_t i = 0; i < free_links.size(); ++i) {
    if (!diagnosis::is_surely_far_from_given(robot, free_links, run.consistent, run.unnoticed.error,
                                             i)) {
      continue;
    }
    const int link = free_links[i];
    const Link& given = robot.links[static_cast<std::size_t>(link)];
    run.notes.push_back(fmt::format(
        "{} has {:.3g} kg here and {:.3g} kg as given, which no error covers: weigh it before "
        "believing either",
        given.name, run.consistent.model.Phi[Eigen::Index{10} * link], given.inertia.mass()));
  }
}

/// It is no refusal as of `identify`: drives and sensors may be what is asked for.
void note_no_mass(DiagnosisRun& run) {
  if (!is_no_mass(run.consistent.model.Phi, run.settings.shapes.free_links,
                  run.settings.expected_mass)) {
    return;
  }
  run.notes.push_back(fmt::format(
      "the log asks for no mass at all where some is sought, so masses and what stands beside them "
      "are not to be believed: {}",
      causes_of_no_mass));
}

/// What gains so much by an impossible value stands for something that is not looked for.
void note_incredible(DiagnosisRun& run) {
  constexpr double much = 0.1, sure = 5.0;
  const diagnosis::Ranked* best = nullptr;
  for (const diagnosis::Ranked& r : run.loop.last_ranking) {
    if (r.credible || !(r.gain > much && r.t > sure)) continue;
    if (best == nullptr || r.gain > best->gain) best = &r;
  }
  if (best == nullptr) return;
  run.notes.push_back(
      fmt::format("{} would take away {:.0f} % of the held-out error that is left ({:.1f} standard "
                  "errors), but by a value beyond what is believed of it: look for what it stands "
                  "for before believing the rest",
                  best->id, 100.0 * best->gain, best->t));
}

void note_worse_joints(const Robot& robot, DiagnosisRun& run) {
  const int base = robot.base_dof();
  for (int j = 0; j < robot.joint_count(); ++j) {
    const double given = run.errors.given[base + j], found = run.errors.found[base + j];
    const std::string now = fmt::format("{:.3g}", found), before = fmt::format("{:.3g}", given);
    if (found > given && now != before) {
      run.notes.push_back(
          fmt::format("{} is predicted worse than by the given model: {} instead of {} {}",
                      robot.joint(j).name, now, before, unit_at(robot.joint(j), "N m")));
    }
  }
}

/// A load that came at some moment of the log has its moment in no other log.
void note_moments(const Robot& robot, const DiagnoseOptions& options, DiagnosisRun& run) {
  if (options.test.empty()) return;
  for (const diagnosis::AppliedEffect& a : run.consistent.model.effects) {
    if (!a.begins()) continue;
    run.notes.push_back(fmt::format(
        "{} came {:.3g} s after the {}log began{}, and is tested as if it came that long after the "
        "test's beginning: hold stretches of the log out instead (without --test)",
        hypothesis_id(robot, a), a.shape[0], options.also.empty() ? "" : "first ",
        options.also.empty() ? "" : " (the others follow it, a second apart)"));
  }
}

/// What was corrected in the logs belongs to the model that goes with them as they were.
void add_flags(const std::vector<diagnosis::Found>& flags, DiagnosisRun& run) {
  for (const diagnosis::Found& f : flags) {
    run.loop.found.push_back(f);
    run.consistent.model.effects.push_back(f.effect);
    run.consistent.effect_error.push_back(f.standard_error);
    run.consistent.load_size_error.push_back(0.0);
    run.notes.push_back(fmt::format("all else is said with {} corrected", f.id));
  }
}

void note_contact_reach(const diagnosis::ContactReach& reach, DiagnosisRun& run) {
  if (diagnosis::ContactReach().covers(reach)) return;
  run.notes.push_back(fmt::format(
      "contacts count as touching {:.3g} ms before and {:.3g} ms after they are declared to, for a "
      "delay of the torque carries their force there",
      1e3 * reach.before, 1e3 * reach.after));
}

/// Errors before and after are of the log alone. What the reference log has besides, and no effect
/// describes, may make changes of others.
void note_reference(const Robot& robot, const Recording& log, const Recording& reference,
                    const diagnosis::Series& remaining, DiagnosisRun& run) {
  const diagnosis::Series before =
      diagnosis::series(robot, run.settings.rows, run.consistent.model.in_reference(), reference,
                        log.stride_for(reference, run.settings.stride));
  const Eigen::VectorXd of_log = remaining.rms(), of_reference = before.rms();
  const Eigen::VectorXd predicted = diagnosis::row_rms(before.predicted, before.counted);
  constexpr double much = 2.0, nothing = 1e-3;  // of the log's, and of what is predicted
  std::vector<std::string> joints;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    if (!(of_reference[row] > much * of_log[row] && of_reference[row] > nothing * predicted[row])) {
      continue;
    }
    joints.push_back(fmt::format("{} {:.3g} {} ({:.3g} in the log)", robot.joint(j).name,
                                 of_reference[row], unit_at(robot.joint(j), "N m"), of_log[row]));
  }
  if (joints.empty()) return;
  run.notes.push_back(fmt::format(
      "of the reference log the model leaves far more than of the log, at {}: something "
      "was there that no effect is, and what is said to have come or gone may stand for it",
      fmt::join(joints, ", ")));
}

Recording* recording_in(std::optional<RecordedLog>& log) { return log ? &log->recording : nullptr; }

/// The steps of a diagnosis, in the order in which they are called.
class Diagnosis {
 public:
  Diagnosis(const RobotInputs& robot, const DiagnoseOptions& options,
            const diagnosis::LoopSettings& settings, DiagnosedLogs logs);

  void close_loop();
  void find_bodies();
  void measure_errors();
  void find_remains();
  void add_notes();
  [[nodiscard]] const std::vector<std::string>& notes() const { return run_.notes; }
  [[nodiscard]] DiagnosisRun take() &&;

 private:
  [[nodiscard]] Recording* reference() { return recording_in(logs_.earlier); }
  [[nodiscard]] diagnosis::Series series(const diagnosis::RichModel& model) const {
    return diagnosis::series(robot_.robot, run_.settings.rows, model, run_.test, run_.test_stride);
  }
  void add_slow_remains(const diagnosis::Series& remaining);
  [[nodiscard]] std::vector<double> noise_of_torque() const;

  const RobotInputs& robot_;
  const DiagnoseOptions& options_;
  DiagnosedLogs logs_;
  Recording& log_;
  const SameLogs same_fitted_;
  const std::optional<SameLogs> same_earlier_;
  std::optional<RecordedLog> rough_, rough_earlier_;  ///< LoopSettings::rough
  DiagnosisRun run_;
  std::vector<diagnosis::Found> flags_;  ///< contact flags that were corrected in the logs
  std::optional<NoiseOfMotion> noise_;   ///< once the loop is closed
};

Diagnosis::Diagnosis(const RobotInputs& robot, const DiagnoseOptions& options,
                     const diagnosis::LoopSettings& settings, DiagnosedLogs logs)
    : robot_(robot),
      options_(options),
      logs_(std::move(logs)),
      log_(logs_.fitted.recording),
      same_fitted_(same_fitted(robot, options, logs_.fitted)),
      same_earlier_(same_earlier(robot, options, logs_.earlier)),
      rough_(same_fitted_.less_smooth()),
      rough_earlier_(same_earlier_ ? same_earlier_->less_smooth() : std::nullopt),
      run_{settings,
           {},
           {},
           {},
           {},
           {},
           {},
           {},
           std::move(logs_.test.recording),
           stride_of(options.inputs, logs_.test.motion.rate),
           {},
           {},
           logs_.fitted.motion,
           robot.all_notes(),
           robot.robot_yaml} {
  run_.settings.rough = recording_in(rough_);
  run_.settings.rough_reference = recording_in(rough_earlier_);
  run_.settings.cutoff = options.inputs.cutoff;
  run_.notes.insert(run_.notes.end(), run_.motion.notes.begin(), run_.motion.notes.end());
}

DiagnosisRun Diagnosis::take() && {
  run_.settings.rough = run_.settings.rough_reference = nullptr;  // they end here
  return std::move(run_);
}

void Diagnosis::close_loop() {
  diagnosis::LoopWithContacts closed = diagnosis::close_loop_with_contacts(
      robot_.robot, log_, reference(),
      {recording_in(rough_), recording_in(rough_earlier_), &run_.test}, run_.settings);
  run_.loop = std::move(closed.loop);
  flags_ = std::move(closed.flags);
  note_contact_reach(closed.reach, run_);
  log_.set_correction(run_.loop.correction);
  noise_.emplace(same_fitted_, same_earlier_, flags_, closed.reach);
  noise_->question_laws(log_, reference(), run_);
  for (diagnosis::Found& f : flags_) {
    f.beside_unknown = diagnosis::is_beside_unknown(robot_.robot, run_.loop, f);
  }
  if (reference() != nullptr) reference()->set_correction(run_.loop.reference_correction);
}

void Diagnosis::find_bodies() {
  const Robot& robot = robot_.robot;
  run_.consistent = diagnosis::make_consistent(robot, log_, reference(), run_.settings, run_.loop);
  diagnosis::add_needed_causes(robot, log_, reference(), run_.settings, run_.loop, run_.consistent);
  diagnosis::add_needed_rotors(robot, log_, reference(), run_.settings, run_.loop, run_.consistent);
  diagnosis::mark_faded(log_, run_.settings, run_.consistent, run_.loop);
  run_.unnoticed =
      diagnosis::unnoticed(robot, log_, reference(), run_.settings, run_.loop, run_.consistent);
  run_.moves_behind_filter = noise_->moves(run_);
  if (run_.moves_behind_filter.size() > 0) {
    diagnosis::allow_for_filter(run_.moves_behind_filter, run_.settings.shapes.free_links,
                                run_.unnoticed);
  }
  run_.causes_alone =
      diagnosis::beside_causes_alone(robot, log_, reference(), run_.settings, run_.loop);
}

void Diagnosis::measure_errors() {
  run_.before = series({stacked_parameters(robot_.robot), {}});
  run_.after = series(run_.consistent.model);
  run_.errors = test_errors(robot_, options_, run_, logs_.raw.recording);
  run_.errors.usual =
      series(diagnosis::usual_model(robot_.robot, log_, run_.settings, run_.loop)).rms();
}

// On the log itself, which is longer and has no error of the filter in it; curves are judged on
// blocks that they were not fitted to.
void Diagnosis::find_remains() {
  const Robot& robot = robot_.robot;
  const diagnosis::LoopSettings& settings = run_.settings;
  const diagnosis::RichModel& model = run_.consistent.model;
  const diagnosis::Series remaining =
      diagnosis::series(robot, settings.rows, model, log_, settings.stride);
  if (reference() != nullptr) note_reference(robot, log_, *reference(), remaining, run_);
  run_.structures = diagnosis::unexplained(robot, log_, remaining, settings.stride);
  noise_->question_curves(log_, remaining, run_);
  run_.curves = diagnosis::curves_for(robot, settings.rows, model, run_.loop, log_, settings.stride,
                                      noise_->silent());
  if (!run_.curves.empty()) {
    diagnosis::RichModel richest = model;
    richest.curves = run_.curves;
    run_.errors.with_curves = series(richest).rms();
  }
  const auto unnamed_effects = unnamed(robot, log_, run_);
  for (const diagnosis::Stranger& s : run_.loop.strangers) {
    run_.structures.push_back(
        diagnosis::lawless(robot, settings.rows, model, log_, settings.stride, s));
  }
  run_.structures.insert(run_.structures.begin(), unnamed_effects.begin(), unnamed_effects.end());
  add_slow_remains(remaining);
}

/// Where no curve was found the residual may still be no noise; but if one was that noise of motion
/// made, what is slow there is a part of that.
void Diagnosis::add_slow_remains(const diagnosis::Series& remaining) {
  const double given = options_.inputs.cutoff;
  const double cutoff = given > 0.0 ? given : 0.5 * run_.motion.rate;
  for (const diagnosis::Structure& slow :
       diagnosis::slow_remains(robot_.robot, log_, remaining, cutoff, noise_of_torque())) {
    const bool known = std::any_of(run_.structures.begin(), run_.structures.end(),
                                   [&](const auto& s) { return s.joint == slow.joint; });
    const bool is_noise = std::ranges::find(noise_->silent(), slow.joint) != noise_->silent().end();
    if (!known && !is_noise) run_.structures.push_back(slow);
  }
}

/// Not a number where the log behind another filter was not read, and of joints at which noise of
/// motion is most of what remains: it makes inertias too small, and what that leaves is slow.
std::vector<double> Diagnosis::noise_of_torque() const {
  const Robot& robot = robot_.robot;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> noise(static_cast<std::size_t>(robot.joint_count()), unknown);
  if (!rough_) return noise;
  MotionInputs less_smooth = options_.inputs;
  less_smooth.cutoff = same_fitted_.less_smooth_cutoff();
  noise =
      diagnosis::torque_noise({robot, run_.settings.rows, {}},
                              {log_, rough_->recording, options_.inputs.cutoff, less_smooth.cutoff},
                              run_.consistent.model.Phi, stride_of(less_smooth, run_.motion.rate));
  for (std::size_t j = 0; j < noise.size(); ++j) {
    if (noise_->is_noisy(robot.joint(static_cast<int>(j)).name)) noise[j] = unknown;
  }
  return noise;
}

void Diagnosis::add_notes() {
  const Robot& robot = robot_.robot;
  add_flags(flags_, run_);
  noise_->note(run_);
  note_rests(robot, run_);
  note_worse_joints(robot, run_);
  note_unsettled_links(robot, run_);
  note_mass_beside_forces(robot, run_);
  note_far_masses(robot, run_);
  note_no_mass(run_);
  note_incredible(run_);
  note_moments(robot, options_, run_);
}

}  // namespace

DiagnosisRun run_diagnosis(const RobotInputs& robot, const DiagnoseOptions& options) {
  refuse_same_logs(options, robot.mapping);
  DiagnosedLogs logs = read_logs(robot, options);
  const diagnosis::LoopSettings settings = settings_for(robot, options, logs.fitted);
  check_logs(robot, options, logs, settings);
  Diagnosis diagnosis(robot, options, settings, std::move(logs));
  with_notes([&] { return diagnosis.notes(); },
             [&] {
               diagnosis.close_loop();
               diagnosis.find_bodies();
               diagnosis.measure_errors();
               diagnosis.find_remains();
               diagnosis.add_notes();
             });
  return std::move(diagnosis).take();
}

}  // namespace shapeid::app
