#include "shapeid/app/recordings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "shapeid/app/noted_refusal.hpp"
#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid::app {
namespace {

// Half an hour at 500 Hz: about a gigabyte for a quadruped, and of several filters and what is held
// out `diagnose` has five times as much (3 MB a second, measured).
constexpr std::size_t most_samples = 1000000;

diagnosis::Recording recording_of(std::vector<Sample> samples, const MotionReport& motion,
                                  const MotionInputs& inputs, double begins) {
  // A name in a log may hold anything that a terminal would act on.
  constexpr std::size_t longest_name = 200;
  std::vector<std::string> extra;
  for (const std::string& name : motion.extra) extra.push_back(one_line(name, longest_name));
  diagnosis::Recording recording(std::move(samples), motion.rate, extra);
  recording.set_origin(begins);
  if (!inputs.exact && inputs.cutoff > 0.0) {
    recording.set_independent_rate(2.0 * band_of_two_passes * inputs.cutoff);
  }
  return recording;
}

}  // namespace

RecordedLog read_recording(const std::string& path, const RobotInputs& robot,
                           const MotionInputs& inputs, std::optional<Part> wanted) {
  LogSamples log(path, robot, inputs);
  std::vector<Sample> samples;
  std::optional<double> start;
  double end = 0.0;
  while (std::optional<Sample> sample = log.next()) {
    if (!start) start = sample->time;
    end = sample->time;
    if (samples.size() == most_samples) {
      throw InputError({path},
                       fmt::format("more than {} samples, all of which are held", most_samples),
                       "half an hour says no less: give a shorter stretch");
    }
    if (!wanted || part_of(sample->time - *start, inputs) == *wanted) samples.push_back(*sample);
  }
  const MotionReport& report = log.report();
  with_notes([&] { return report.notes; }, [&] { refuse_without_samples(report); });
  const double begins = start.value_or(0.0);
  return {recording_of(std::move(samples), report, inputs, begins),
          report,
          log.contacts(),
          begins,
          end,
          {0.0}};
}

void check_contacts_alike(const ContactSource& first, const ContactSource& other,
                          ContactTreatment contacts) {
  if (contacts != ContactTreatment::project || other.derived == first.derived) return;
  throw InputError({other.path},
                   fmt::format("has {}contact.* columns, and {} has {}", other.derived ? "no " : "",
                               first.path, first.derived ? "none" : "some"),
                   "logs that all have contacts, or none; or --contacts measured or none");
}

RecordedLog read_recordings(const std::vector<std::string>& paths, const RobotInputs& robot,
                            const MotionInputs& inputs, std::optional<Part> wanted,
                            const std::vector<double>& shifts) {
  constexpr double pause = 1.0;       // s: a gap for everything that looks at neighbours
  constexpr double same_rate = 0.01;  // relative
  RecordedLog all = read_recording(paths.front(), robot, inputs, wanted);
  std::vector<Sample> samples = all.recording.samples();
  for (std::size_t k = 1; k < paths.size(); ++k) {
    const RecordedLog more = read_recording(paths[k], robot, inputs, wanted);
    if (!(std::abs(more.motion.rate - all.motion.rate) <= same_rate * all.motion.rate)) {
      throw InputError({paths[k]},
                       fmt::format("has {:.4g} samples a second, {} has {:.4g}", more.motion.rate,
                                   paths.front(), all.motion.rate),
                       "--rate, for a grid that all share");
    }
    if (more.motion.extra != all.motion.extra || more.contacts != all.contacts) {
      throw InputError({paths[k]}, "has other columns than " + paths.front(),
                       "logs with the same columns");
    }
    check_contacts_alike({paths.front(), all.motion.contacts_derived},
                         {paths[k], more.motion.contacts_derived}, all.contacts);
    if (!more.recording.samples().empty() && !samples.empty()) all.starts.push_back(samples.size());
    const double shift = shifts.empty() ? all.ends + pause - more.begins : shifts[k];
    all.ends = more.ends + shift;
    all.shifts.push_back(shift);
    for (Sample sample : more.recording.samples()) {
      sample.time += shift;
      samples.push_back(std::move(sample));
    }
    all.motion.rows += more.motion.rows;
    all.motion.samples += more.motion.samples;
    all.motion.gaps += more.motion.gaps + 1;
    for (const std::string& note : more.motion.notes) {
      all.motion.notes.push_back(paths[k] + ": " + note);
    }
  }
  all.recording = recording_of(std::move(samples), all.motion, inputs, all.begins);
  return all;
}

}  // namespace shapeid::app
