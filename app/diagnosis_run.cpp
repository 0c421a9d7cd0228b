#include "shapeid/app/diagnosis_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "shapeid/app/diagnosis_logs.hpp"
#include "shapeid/app/motion_noise.hpp"
#include "shapeid/diagnosis/checks.hpp"
#include "shapeid/diagnosis/contact_reach.hpp"
#include "shapeid/diagnosis/contacts_in_loop.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/diagnosis/needed.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/diagnosis/slowness.hpp"
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
  const auto& samples = raw.samples();
  for (Eigen::Index i = 0; i < tau.cols(); ++i) {
    const double time = smooth[series.index[static_cast<std::size_t>(i)]].time;
    const auto at = std::lower_bound(samples.begin(), samples.end(), time - 0.25 / raw.rate(),
                                     [](const Sample& s, double t) { return s.time < t; });
    if (at != samples.end() && std::abs(at->time - time) < 0.25 / raw.rate()) {
      tau.col(i) = at->tau;
    }
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
    if (!f.varies) continue;
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
    if (!run.causes_alone ||
        !diagnosis::hangs_on_descriptions(run.consistent, *run.causes_alone, link)) {
      continue;
    }
    const Eigen::Index mass = Eigen::Index{10} * link;
    run.notes.push_back(
        fmt::format("the inertia of {} is not identified: it hangs on effects that are no causes "
                    "(mass {:.3g} kg beside them, {:.3g} kg without)",
                    robot.links[static_cast<std::size_t>(link)].name,
                    run.consistent.model.Phi[mass], run.causes_alone->model.Phi[mass]));
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
  for (const int link : run.settings.shapes.free_links) {
    if (!diagnosis::is_far_from_given(robot, run.consistent, run.unnoticed.error, link)) continue;
    const Link& given = robot.links[static_cast<std::size_t>(link)];
    run.notes.push_back(fmt::format(
        "{} has {:.3g} kg here and {:.3g} kg as given, which no error covers: weigh it before "
        "believing either",
        given.name, run.consistent.model.Phi[Eigen::Index{10} * link], given.inertia.mass()));
  }
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
        "{} came {:.3g} s after the log began, and is tested as if it came that long after the "
        "test's beginning: hold stretches of the log out instead (without --test)",
        hypothesis_id(robot, a), a.shape[0]));
  }
}

/// What is wrong with another log than the one that is diagnosed names that log.
template <typename Check>
void check_other(const std::string& path, const Check& check) {
  try {
    check();
  } catch (const Refusal& refusal) {
    throw Refusal(refusal.code(), fmt::format("{}: {}", path, refusal.reason()));
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

}  // namespace

DiagnosisRun run_diagnosis(const RobotInputs& robot, const DiagnoseOptions& options) {
  refuse_same_logs(options);
  const bool split = options.test.empty();
  const std::optional<Part> fitted_part = split ? std::optional(Part::fitted) : std::nullopt;
  RecordedLog log = read_recordings(fitted_logs(options), robot, options.inputs, fitted_part);
  if (split && log.recording.samples().empty()) refuse_all_held_out(log.motion.samples);
  diagnosis::check_recording(robot.robot, log.recording, log.contacts);
  const std::vector<std::string> test_paths = split ? fitted_logs(options) : options.test;
  const std::optional<Part> test_part = split ? std::optional(Part::held_out) : std::nullopt;
  RecordedLog test = read_recordings(test_paths, robot, options.inputs, test_part,
                                     split ? log.shifts : std::vector<double>());
  check_contacts_alike({options.inputs.log, log.motion.contacts_derived},
                       {test_paths.front(), test.motion.contacts_derived}, log.contacts);
  MotionInputs unsmoothed = options.inputs;
  unsmoothed.cutoff = 0.0;
  const RecordedLog raw = read_recordings(test_paths, robot, unsmoothed, test_part, test.shifts);
  std::optional<RecordedLog> earlier;
  if (!options.reference.empty()) {
    earlier = read_recording(options.reference, robot, options.inputs, std::nullopt);
    check_other(options.reference, [&] {
      diagnosis::check_recording(robot.robot, earlier->recording, earlier->contacts);
    });
    check_contacts_alike({options.inputs.log, log.motion.contacts_derived},
                         {options.reference, earlier->motion.contacts_derived}, log.contacts);
  }

  DiagnosisRun run{settings_for(robot, options, log),
                   {},
                   {},
                   {},
                   {},
                   {},
                   {},
                   {},
                   std::move(test.recording),
                   stride_of(options.inputs, test.motion.rate),
                   {},
                   {},
                   log.motion,
                   robot.robot.notes};
  if (run.test.usable(run.test_stride).empty()) {
    throw Refusal("no-data", "nothing is left to test on; give --test, or a longer log");
  }
  diagnosis::check_clocks(robot.robot, log.recording, run.settings, log.starts);
  if (earlier) {
    check_other(options.reference,
                [&] { diagnosis::check_clocks(robot.robot, earlier->recording, run.settings); });
  }
  if (!split) {
    check_other(fmt::format("{}", fmt::join(options.test, ", ")), [&] {
      diagnosis::check_meaning(robot.robot, run.test, log.contacts);
      diagnosis::check_clocks(robot.robot, run.test, run.settings, test.starts);
    });
  }
  const SameLogs same{robot,       options.inputs,  fitted_logs(options),
                      fitted_part, log.motion.rate, log.shifts};
  std::optional<SameLogs> same_earlier;
  if (earlier) {
    same_earlier.emplace(SameLogs{robot,
                                  options.inputs,
                                  {options.reference},
                                  std::nullopt,
                                  earlier->motion.rate,
                                  earlier->shifts});
  }
  std::optional<RecordedLog> rough = same.less_smooth();
  std::optional<RecordedLog> rough_earlier;
  if (same_earlier) rough_earlier = same_earlier->less_smooth();
  const auto pointer = [](std::optional<RecordedLog>& of) { return of ? &of->recording : nullptr; };
  run.settings.rough = pointer(rough);
  run.settings.rough_reference = pointer(rough_earlier);
  run.settings.cutoff = options.inputs.cutoff;
  Recording* reference = pointer(earlier);
  const std::vector<Recording*> along = {pointer(rough), pointer(rough_earlier), &run.test};
  diagnosis::LoopWithContacts closed = diagnosis::close_loop_with_contacts(
      robot.robot, log.recording, reference, along, run.settings);
  run.loop = std::move(closed.loop);
  std::vector<diagnosis::Found>& flags = closed.flags;
  note_contact_reach(closed.reach, run);
  log.recording.set_correction(run.loop.correction);
  NoiseOfMotion noise(same, same_earlier, flags, closed.reach);
  noise.question_laws(log.recording, reference, run);
  for (diagnosis::Found& f : flags) {
    f.beside_unknown = diagnosis::is_beside_unknown(robot.robot, run.loop, f);
  }
  if (reference != nullptr) reference->set_correction(run.loop.reference_correction);
  run.consistent =
      diagnosis::make_consistent(robot.robot, log.recording, reference, run.settings, run.loop);
  diagnosis::add_needed_causes(robot.robot, log.recording, reference, run.settings, run.loop,
                               run.consistent);
  diagnosis::add_needed_rotors(robot.robot, log.recording, reference, run.settings, run.loop,
                               run.consistent);
  diagnosis::mark_faded(log.recording, run.settings, run.consistent, run.loop);
  run.unnoticed = diagnosis::unnoticed(robot.robot, log.recording, reference, run.settings,
                                       run.loop, run.consistent);
  run.causes_alone =
      diagnosis::beside_causes_alone(robot.robot, log.recording, reference, run.settings, run.loop);
  run.robot_yaml = robot.robot_yaml;
  run.notes.insert(run.notes.end(), robot.remarks.begin(), robot.remarks.end());
  run.notes.insert(run.notes.end(), robot.warnings.begin(), robot.warnings.end());
  run.notes.insert(run.notes.end(), log.motion.notes.begin(), log.motion.notes.end());
  const diagnosis::RichModel given{stacked_parameters(robot.robot), {}};
  run.before = diagnosis::series(robot.robot, run.settings.rows, given, run.test, run.test_stride);
  run.after = diagnosis::series(robot.robot, run.settings.rows, run.consistent.model, run.test,
                                run.test_stride);
  run.errors = test_errors(robot, options, run, raw.recording);
  run.errors.usual =
      diagnosis::series(robot.robot, run.settings.rows,
                        diagnosis::usual_model(robot.robot, log.recording, run.settings, run.loop),
                        run.test, run.test_stride)
          .rms();
  // On the log itself, which is longer and has no error of the filter in it; curves are judged on
  // blocks that they were not fitted to.
  const diagnosis::Series remaining = diagnosis::series(
      robot.robot, run.settings.rows, run.consistent.model, log.recording, run.settings.stride);
  run.structures =
      diagnosis::unexplained(robot.robot, log.recording, remaining, run.settings.stride);
  noise.question_curves(log.recording, remaining, run);
  diagnosis::RichModel richest = run.consistent.model;
  richest.curves = run.curves =
      diagnosis::curves_for(robot.robot, run.settings.rows, run.consistent.model, run.loop,
                            log.recording, run.settings.stride, noise.silent());
  if (!run.curves.empty()) {
    run.errors.with_curves =
        diagnosis::series(robot.robot, run.settings.rows, richest, run.test, run.test_stride).rms();
  }
  const auto unnamed_effects = unnamed(robot.robot, log.recording, run);
  for (const diagnosis::Stranger& s : run.loop.strangers) {
    run.structures.push_back(diagnosis::lawless(robot.robot, run.settings.rows,
                                                run.consistent.model, log.recording,
                                                run.settings.stride, s));
  }
  run.structures.insert(run.structures.begin(), unnamed_effects.begin(), unnamed_effects.end());
  // Where no curve was found the residual may still be no noise; but if one was that noise of
  // motion made, what is slow there is a part of that.
  const double cutoff = options.inputs.cutoff > 0.0 ? options.inputs.cutoff : 0.5 * run.motion.rate;
  for (const diagnosis::Structure& slow :
       diagnosis::slow_remains(robot.robot, log.recording, remaining, cutoff)) {
    const bool known = std::any_of(run.structures.begin(), run.structures.end(),
                                   [&](const auto& s) { return s.joint == slow.joint; });
    const bool is_noise = std::ranges::find(noise.silent(), slow.joint) != noise.silent().end();
    if (!known && !is_noise) run.structures.push_back(slow);
  }
  add_flags(flags, run);
  noise.note(run);
  note_rests(robot.robot, run);
  note_worse_joints(robot.robot, run);
  note_unsettled_links(robot.robot, run);
  note_mass_beside_forces(robot.robot, run);
  note_far_masses(robot.robot, run);
  note_moments(robot.robot, options, run);
  run.settings.rough = run.settings.rough_reference = nullptr;  // they end here
  return run;
}

}  // namespace shapeid::app
