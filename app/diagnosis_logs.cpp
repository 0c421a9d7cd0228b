#include "shapeid/app/diagnosis_logs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/app/shared_stretches.hpp"
#include "shapeid/diagnosis/checks.hpp"
#include "shapeid/diagnosis/joint_signs.hpp"
#include "shapeid/diagnosis/motion_noise.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

/// Of the logs that are fitted; all of them, where others are for testing.
std::optional<Part> fitted_part(const DiagnoseOptions& options) {
  return options.test.empty() ? std::optional(Part::fitted) : std::nullopt;
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

/// What the logs of a set mean, of each by itself: among others one of another sign or unit would
/// only make all of them unclear. The one that is refused is named, but for the only one there is.
void check_meaning_of_each(const Robot& robot, const DiagnoseOptions& options,
                           const RecordedLog& set, const std::vector<std::string>& paths,
                           ContactTreatment contacts) {
  const std::vector<Sample>& all = set.recording.samples();
  // A log without samples begins nowhere, and leaves open which are the others.
  const bool is_named = set.starts.size() + 1 == paths.size() &&
                        (paths.size() > 1 || paths.front() != options.inputs.log);
  for (std::size_t k = 0; k <= set.starts.size(); ++k) {
    const auto from = static_cast<std::ptrdiff_t>(k == 0 ? 0 : set.starts[k - 1]);
    const auto to = static_cast<std::ptrdiff_t>(k < set.starts.size() ? set.starts[k] : all.size());
    if (from == to) continue;
    const diagnosis::Recording log({all.begin() + from, all.begin() + to}, set.recording.rate(),
                                   set.recording.extra());
    const auto check = [&] { diagnosis::check_meaning(robot, log, contacts); };
    if (is_named) {
      check_other(paths[k], check);
    } else {
      check();
    }
  }
}

/// The settings for a log of another rate than the one that is diagnosed.
diagnosis::LoopSettings settings_for(const RecordedLog& log, const DiagnoseOptions& options,
                                     diagnosis::LoopSettings settings) {
  settings.stride = stride_of(options.inputs, log.motion.rate);
  return settings;
}

}  // namespace

std::vector<std::string> fitted_logs(const DiagnoseOptions& options) {
  std::vector<std::string> paths = {options.inputs.log};
  paths.insert(paths.end(), options.also.begin(), options.also.end());
  return paths;
}

void refuse_same_logs(const DiagnoseOptions& options, const std::optional<Mapping>& mapping) {
  LogsByUse logs{fitted_logs(options), {}, options.test};
  if (!options.reference.empty()) logs.earlier.push_back(options.reference);
  refuse_same_data(logs, mapping);
}

DiagnosedLogs read_logs(const RobotInputs& robot, const DiagnoseOptions& options) {
  const bool split = options.test.empty();
  const std::vector<std::string> fitted_paths = fitted_logs(options);
  RecordedLog fitted = read_recordings(fitted_paths, robot, options.inputs, fitted_part(options));
  with_notes([&] { return fitted.motion.notes; },
             [&] {
               if (split && fitted.recording.samples().empty())
                 refuse_all_held_out(fitted.motion.samples);
               diagnosis::check_excitation(robot.robot, fitted.recording);
               check_meaning_of_each(robot.robot, options, fitted, fitted_paths, fitted.contacts);
             });

  const std::vector<std::string>& test_paths = split ? fitted_paths : options.test;
  const std::optional<Part> test_part = split ? std::optional(Part::held_out) : std::nullopt;
  RecordedLog test = read_recordings(test_paths, robot, options.inputs, test_part,
                                     split ? fitted.shifts : std::vector<double>());
  const ContactSource contacts{options.inputs.log, fitted.motion.contacts_derived};
  check_contacts_alike(contacts, {test_paths.front(), test.motion.contacts_derived},
                       fitted.contacts);
  MotionInputs unsmoothed = options.inputs;
  unsmoothed.cutoff = 0.0;
  RecordedLog raw = read_recordings(test_paths, robot, unsmoothed, test_part, test.shifts);

  std::optional<RecordedLog> earlier;
  if (!options.reference.empty()) {
    earlier = read_recording(options.reference, robot, options.inputs, std::nullopt);
    with_notes([&] { return earlier->motion.notes; },
               [&] {
                 check_other(options.reference, [&] {
                   diagnosis::check_excitation(robot.robot, earlier->recording);
                   diagnosis::check_meaning(robot.robot, earlier->recording, earlier->contacts);
                 });
               });
    check_contacts_alike(contacts, {options.reference, earlier->motion.contacts_derived},
                         fitted.contacts);
  }
  return {std::move(fitted), std::move(test), std::move(raw), std::move(earlier)};
}

namespace {

void check_each(const RobotInputs& robot, const DiagnoseOptions& options, const DiagnosedLogs& logs,
                const diagnosis::LoopSettings& settings) {
  const RecordedLog &fitted = logs.fitted, &test = logs.test;
  if (test.recording.usable(stride_of(options.inputs, test.motion.rate)).empty()) {
    const std::size_t samples = test.recording.samples().size();
    // Of logs of few samples a second all stretches that are held out are as short.
    throw Refusal(
        "no-data",
        samples == 0
            ? "nothing is left to test on; give --test, or a longer log"
            : fmt::format(
                  "nothing is left to test on: of {} samples none that counts has neighbours "
                  "for {:g} ms, and two more, on both sides; give --test, with a log of longer "
                  "stretches",
                  samples, 1e3 * diagnosis::largest_shift));
  }
  diagnosis::check_clocks(robot.robot, fitted.recording, settings, fitted.starts,
                          fitted_logs(options));
  diagnosis::check_joint_signs(robot.robot, fitted.recording, settings);
  if (logs.earlier) {
    diagnosis::check_clocks(robot.robot, logs.earlier->recording,
                            settings_for(*logs.earlier, options, settings), {},
                            {options.reference});
  }
  if (options.test.empty()) return;
  check_meaning_of_each(robot.robot, options, test, options.test, fitted.contacts);
  diagnosis::check_clocks(robot.robot, test.recording, settings_for(test, options, settings),
                          test.starts, options.test);
}

}  // namespace

void check_logs(const RobotInputs& robot, const DiagnoseOptions& options, const DiagnosedLogs& logs,
                const diagnosis::LoopSettings& settings) {
  with_notes([&] { return logs.fitted.motion.notes; },
             [&] { check_each(robot, options, logs, settings); });
}

double margin_of(const MotionInputs& inputs, double rate) {
  constexpr double longest = 0.1;
  return std::min(0.5 / (inputs.cutoff > 0.0 ? inputs.cutoff : rate), longest);
}

double SameLogs::less_smooth_cutoff() const {
  constexpr double times = 3.0, highest = 0.4;  // of the rate
  return std::min(times * inputs.cutoff, highest * rate);
}

std::optional<RecordedLog> SameLogs::less_smooth() const {
  MotionInputs other = inputs;
  other.cutoff = less_smooth_cutoff();
  if (inputs.exact || inputs.causal || !(other.cutoff > inputs.cutoff)) return {};
  return read_recordings(paths, robot, other, part, shifts);
}

std::optional<RecordedLog> SameLogs::smoother() const {
  if (inputs.exact || !(inputs.cutoff > 0.0)) return {};
  MotionInputs other = inputs;
  other.cutoff *= diagnosis::slower_by;
  return read_recordings(paths, robot, other, part, shifts);
}

SameLogs same_fitted(const RobotInputs& robot, const DiagnoseOptions& options,
                     const RecordedLog& fitted) {
  return {
      robot,        options.inputs, fitted_logs(options), fitted_part(options), fitted.motion.rate,
      fitted.shifts};
}

std::optional<SameLogs> same_earlier(const RobotInputs& robot, const DiagnoseOptions& options,
                                     const std::optional<RecordedLog>& earlier) {
  if (!earlier) return std::nullopt;
  return SameLogs{robot,        options.inputs,       {options.reference},
                  std::nullopt, earlier->motion.rate, earlier->shifts};
}

}  // namespace shapeid::app
