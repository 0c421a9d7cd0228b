#include "shapeid/app/motion_noise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "shapeid/diagnosis/contact_flags.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {

NoiseOfMotion::NoiseOfMotion(SameLogs log, std::optional<SameLogs> reference,
                             const std::vector<diagnosis::Found>& flags,
                             const diagnosis::ContactReach& reach)
    : log_inputs_(std::move(log)),
      reference_inputs_(std::move(reference)),
      flags_(flags),
      reach_(reach) {}

diagnosis::FilteredLogs NoiseOfMotion::smoother(const DiagnosisRun& run) {
  if (!log_) {
    log_ = log_inputs_.smoother();
    if (reference_inputs_) reference_ = reference_inputs_->smoother();
    for (std::optional<RecordedLog>* of : {&log_, &reference_}) {
      if (!*of) continue;
      diagnosis::correct_contact_flags((*of)->recording, flags_);
      (*of)->recording.extend_contacts(reach_.before, reach_.after);
    }
    MotionInputs inputs = log_inputs_.inputs;
    inputs.cutoff *= diagnosis::slower_by;
    settings_ = run.settings;
    settings_.cutoff = inputs.cutoff;
    settings_.stride = stride_of(inputs, log_inputs_.rate);
    settings_.margin = margin_of(inputs, log_inputs_.rate);
    settings_.log_starts = log_->starts;
  }
  if (log_->recording.samples().empty()) {
    throw Refusal("too-short", "nothing is left of the log behind the slower filter");
  }
  return {log_->recording, reference_ ? &reference_->recording : nullptr, settings_};
}

void NoiseOfMotion::question_laws(const diagnosis::Recording& log,
                                  const diagnosis::Recording* reference, DiagnosisRun& run) {
  const Robot& robot = log_inputs_.robot.robot;
  if (log_inputs_.inputs.exact || !(log_inputs_.inputs.cutoff > 0.0)) return;
  fast_shares_ = diagnosis::fast_shares(
      robot, log,
      diagnosis::series(robot, run.settings.rows, run.loop.model, log, run.settings.stride),
      run.settings.cutoff);
  had_noise_for_name_.assign(fast_shares_.size(), false);
  try {
    if (std::ranges::any_of(fast_shares_, diagnosis::is_noise_of_motion)) {
      if (!run.loop.found.empty()) take_back_names(log, reference, run);
    } else if (std::ranges::any_of(run.loop.found, &diagnosis::Found::name_stands)) {
      diagnosis::doubt_names(robot, {log, reference, run.settings}, smoother(run), run.loop);
    }
    const auto& laws = run.loop.strangers;
    if (std::none_of(laws.begin(), laws.end(), [&](const diagnosis::Stranger& s) {
          return is_noisy(robot.joint(s.law.joint).name);
        })) {
      return;
    }
    std::vector<double> shares = fast_shares_;
    for (std::size_t j = 0; j < shares.size(); ++j) {
      if (had_noise_for_name_[j]) shares[j] = 1.0;
    }
    for (const diagnosis::Stranger& s :
         diagnosis::take_back_noise(robot, smoother(run), shares, run.loop)) {
      taken_back_.push_back(diagnosis::law_text(s, robot));
    }
  } catch (const Refusal& refusal) {
    why_not_asked_ = refusal.reason();
  }
}

/// Where a name was noise, so may be a law without one.
void NoiseOfMotion::take_back_names(const diagnosis::Recording& log,
                                    const diagnosis::Recording* reference, DiagnosisRun& run) {
  const Robot& robot = log_inputs_.robot.robot;
  for (const diagnosis::Found& f :
       diagnosis::take_back_names(robot, {log, reference, run.settings}, smoother(run), run.loop)) {
    names_taken_back_.push_back(f.id);
    const std::vector<bool> reach = diagnosis::reach_of(robot, f.effect);
    if (std::ranges::count(reach, true) != 1) continue;  // all the joints that move a link
    had_noise_for_name_[static_cast<std::size_t>(std::ranges::find(reach, true) - reach.begin())] =
        true;
  }
}

Eigen::VectorXd NoiseOfMotion::moves(const DiagnosisRun& run) {
  const bool is_asked = !run.settings.shapes.free_links.empty();
  if (!is_asked || log_inputs_.inputs.exact || !(log_inputs_.inputs.cutoff > 0.0)) return {};
  try {
    return diagnosis::moves_behind(log_inputs_.robot.robot, smoother(run), run.loop);
  } catch (const Refusal&) {
    return {};
  }
}

void NoiseOfMotion::question_curves(const diagnosis::Recording& log,
                                    const diagnosis::Series& remaining, DiagnosisRun& run) {
  const Robot& robot = log_inputs_.robot.robot;
  if (fast_shares_.empty()) return;
  fast_shares_ = diagnosis::fast_shares(robot, log, remaining, run.settings.cutoff);
  const auto noisy = [&](const diagnosis::Structure& s) { return is_noisy(s.joint); };
  if (std::none_of(run.structures.begin(), run.structures.end(), noisy)) return;
  std::vector<diagnosis::Structure> now;
  try {
    now = diagnosis::unexplained_behind(robot, smoother(run), run.loop);
  } catch (const Refusal& refusal) {
    why_not_asked_ = refusal.reason();
    return;
  }
  std::erase_if(run.structures, [&](const diagnosis::Structure& s) {
    const bool gone = noisy(s) && std::none_of(now.begin(), now.end(), [&](const auto& other) {
                        return other.joint == s.joint;
                      });
    if (gone) {
      taken_back_.push_back(fmt::format("{} over {}", s.joint, s.variable));
      silent_.push_back(s.joint);
    }
    return gone;
  });
}

void NoiseOfMotion::note(DiagnosisRun& run) const {
  std::vector<std::string> noisy;
  const Robot& robot = log_inputs_.robot.robot;
  for (std::size_t j = 0; j < fast_shares_.size(); ++j) {
    if (!diagnosis::is_noise_of_motion(fast_shares_[j])) continue;
    noisy.push_back(robot.joint(static_cast<int>(j)).name);
  }
  const double slower = diagnosis::slower_by * run.settings.cutoff;
  if (!noisy.empty()) {
    run.notes.push_back(fmt::format(
        "most of what remains of {} is faster than {:.3g} Hz, as noise of differentiated positions "
        "is: with --cutoff {:.3g} less of it remains, and smaller effects can be seen",
        fmt::join(noisy, ", "), slower, slower));
  }
  if (!why_not_asked_.empty()) {
    run.notes.push_back(fmt::format(
        "whether what is unexplained is noise of differentiated positions was not asked behind a "
        "filter of {:.3g} Hz: {}",
        slower, why_not_asked_));
  }
  if (!names_taken_back_.empty()) {
    run.notes.push_back(fmt::format("gone behind a filter of {:.3g} Hz, and so no cause: {}",
                                    slower, fmt::join(names_taken_back_, ", ")));
  }
  std::vector<std::string> lost;
  for (const diagnosis::Found& f : run.loop.found) {
    if (f.is_lost_when_slower) lost.push_back(f.id);
  }
  if (!lost.empty()) {
    run.notes.push_back(fmt::format(
        "lost behind a filter of {:.3g} Hz, and so no cause; noise of differentiated positions "
        "makes such names, and --cutoff {:.3g} leaves less of it: {}",
        slower, slower, fmt::join(lost, ", ")));
  }
  if (taken_back_.empty()) return;
  run.notes.push_back(fmt::format("gone behind a filter of {:.3g} Hz, and so not unexplained: {}",
                                  slower, fmt::join(taken_back_, ", ")));
}

bool NoiseOfMotion::is_noisy(const std::string& joint) const {
  const std::optional<int> j = log_inputs_.robot.robot.find_joint(joint);
  if (!j || fast_shares_.empty()) return false;
  const auto at = static_cast<std::size_t>(*j);
  return had_noise_for_name_[at] || diagnosis::is_noise_of_motion(fast_shares_[at]);
}

}  // namespace shapeid::app
