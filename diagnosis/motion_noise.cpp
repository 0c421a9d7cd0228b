#include "shapeid/diagnosis/motion_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "shapeid/diagnosis/candidates.hpp"
#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/loop_state.hpp"
#include "shapeid/diagnosis/names.hpp"
#include "shapeid/diagnosis/refit.hpp"
#include "shapeid/diagnosis/spectrum.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr std::size_t fewest = 8;  // frequencies on either side
// Two passes of second order leave 0.41 of white noise's power above half their cutoff, and 0.98 of
// that of noise whose power grows with the fourth power of frequency.
constexpr double mostly_fast = 0.8;
// Noise of motion is as strong in what is predicted as in what remains; motion itself is not.
constexpr double motion_as_fast = 2.0;

// Of what a finding gained: of 150 on drawn arms four false ones had a tenth of it at most behind
// the slower filter, and all others more than it (docs/derivations/diagnosis-history.md).
constexpr double kept_share = 0.5;

// Of the squared error that it explained. Right names on trots and drawn arms kept 0.6 and more,
// ten wrong ones on a log of coarse encoders 0.03 at most; on measured logs some lie between
// (docs/derivations/diagnosis-history.md).
constexpr double kept_worth = 0.25;

/// Tapered anew between gaps, of unit power still: of ends and gaps a slow motion would seem fast.
/// What stands between gaps for less than `shortest` (s) is zero; all is where nothing else is.
Eigen::VectorXd tapered(const std::vector<double>& time, double shortest, Eigen::VectorXd y) {
  const double gap = 1.5 * usual_step(time);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(y.size());
  std::size_t begin = 0;
  while (begin < time.size()) {
    std::size_t end = begin + 1;
    while (end < time.size() && time[end] - time[end - 1] < gap) ++end;
    const double duration = time[end - 1] - time[begin];
    for (std::size_t i = begin; i < end && duration >= shortest; ++i) {
      const double part = (time[i] - time[begin]) / duration;
      shape[static_cast<Eigen::Index>(i)] = std::pow(std::sin(std::numbers::pi * part), 2);
    }
    begin = end;
  }
  const double size = shape.norm() / std::sqrt(static_cast<double>(y.size()));
  return size > 0.0 ? (y.array() * shape.array() / size).matrix() : y;
}

/// What the loop has come to, before the smoother logs.
LoopState behind(const Robot& robot, const FilteredLogs& smoother, const LoopResult& loop) {
  LoopState state(robot, smoother.log, smoother.reference, smoother.settings);
  state.fit_masses();
  state.result = loop;
  state.result.correction.clear();
  state.correct();
  state.reweigh();
  return state;
}

/// Weighted, held out, by the present model.
double squares_a_sample(LoopState& state) {
  const BlockFits fits = state.tallied(state.result.model.effects);
  double samples = 0.0;
  for (const auto& block : fits.tally().blocks) samples += static_cast<double>(block.samples);
  return fits.held_out(state.terms_of_model(fits, state.result.found.size())).sum() / samples;
}

/// Its column is a rate of change: of what is as strong at all frequencies, the squares behind half
/// the cutoff are an eighth.
bool is_of_rates(const Effect& effect) {
  return effect.filters_load || &effect == find_effect("torque_delay") ||
         &effect == find_effect("imu_delay");
}

}  // namespace

std::vector<double> fast_shares(const Robot& robot, const Recording& recording,
                                const Series& series, double cutoff) {
  std::vector<double> shares(static_cast<std::size_t>(robot.joint_count()), 0.0);
  const std::vector<double> time = times(recording, series);
  if (time.size() < fewest) return shares;
  const double shortest = static_cast<double>(fewest) / (slower_by * cutoff);
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    const double highest = 0.5 / usual_step(time);
    const Spectrum left = spectrum(time, centred(series, series.residual, row), highest);
    const Spectrum asked =
        spectrum(time, tapered(time, shortest, centred(series, series.predicted, row)), highest);
    const std::size_t from = left.at(slower_by * cutoff), end = left.power.size();
    if (from < fewest || end - from < fewest) continue;
    const double all = left.mean(0, end) * static_cast<double>(end);
    const double fast = left.mean(from, end);
    const bool moves_as_fast = asked.mean(from, end) > motion_as_fast * fast;
    if (!(all > 0.0) || moves_as_fast) continue;
    shares[static_cast<std::size_t>(j)] = fast * static_cast<double>(end - from) / all;
  }
  return shares;
}

bool is_noise_of_motion(double fast_share) { return fast_share > mostly_fast; }

std::vector<Found> take_back_names(const Robot& robot, const FilteredLogs& logs,
                                   const FilteredLogs& smoother, LoopResult& loop) {
  LoopState smooth = behind(robot, smoother, loop);
  refit_numbers(smooth);
  const std::vector<Gain> now = smooth.gains();
  std::vector<Found> gone, stay;
  for (std::size_t k = 0; k < loop.found.size(); ++k) {
    const Found& f = loop.found[k];
    const bool is_too_fast = is_fast_ripple(logs.log, f.effect, smoother.settings.cutoff);
    (!is_too_fast && now[k].share < kept_share * f.gain ? gone : stay).push_back(f);
  }
  if (gone.empty()) return gone;
  LoopState state(robot, logs.log, logs.reference, logs.settings);
  state.result = loop;
  state.use_correction(loop.correction, loop.reference_correction);
  state.result.found = std::move(stay);
  state.collect_effects();
  refit_numbers(state);
  const std::vector<Gain> left = state.gains();
  for (std::size_t k = 0; k < left.size(); ++k) {
    state.result.found[k].gain = left[k].share;
    state.result.found[k].t = left[k].t;
  }
  state.result.error_end = state.held_out_of_log().sum() /
                           (static_cast<double>(loop.samples) * static_cast<double>(robot.dof()));
  loop = std::move(state.result);
  return gone;
}

void doubt_names(const Robot& robot, const FilteredLogs& logs, const FilteredLogs& smoother,
                 LoopResult& loop) {
  LoopState state(robot, logs.log, logs.reference, logs.settings);
  state.result = loop;
  state.use_correction(loop.correction, loop.reference_correction);
  LoopState smooth = behind(robot, smoother, loop);
  smooth.result.weight = loop.weight;  // squares of both are of one unit
  refit_numbers(smooth);
  const std::vector<Gain> now = smooth.gains();
  const double before = squares_a_sample(state), left = squares_a_sample(smooth);
  for (std::size_t k = 0; k < loop.found.size(); ++k) {
    Found& f = loop.found[k];
    if (is_of_rates(*f.effect.effect) ||
        is_fast_ripple(logs.log, f.effect, smoother.settings.cutoff)) {
      continue;
    }
    f.is_lost_when_slower =
        f.name_stands() && worth(now[k].share) * left < kept_worth * worth(f.gain) * before;
  }
}

std::vector<Stranger> take_back_noise(const Robot& robot, const FilteredLogs& smoother,
                                      const std::vector<double>& fast_shares, LoopResult& loop) {
  LoopState state = behind(robot, smoother, loop);
  question_names(state);
  const auto stays = [&](const Stranger& s) {
    const auto joint = static_cast<std::size_t>(s.law.joint);
    const auto& now = state.result.strangers;
    return !is_noise_of_motion(fast_shares[joint]) ||
           std::any_of(now.begin(), now.end(),
                       [&](const Stranger& other) { return other.law.joint == s.law.joint; });
  };
  const auto gone = std::stable_partition(loop.strangers.begin(), loop.strangers.end(), stays);
  std::vector<Stranger> taken_back(gone, loop.strangers.end());
  loop.strangers.erase(gone, loop.strangers.end());
  if (!taken_back.empty()) loop.found = state.result.found;
  return taken_back;
}

std::vector<Structure> unexplained_behind(const Robot& robot, const FilteredLogs& smoother,
                                          const LoopResult& loop) {
  LoopState state = behind(robot, smoother, loop);
  refit_numbers(state);
  return unexplained(robot, state.log, state.left_by(state.result.model), smoother.settings.stride);
}

Eigen::VectorXd moves_behind(const Robot& robot, const FilteredLogs& smoother,
                             const LoopResult& loop) {
  LoopState state = behind(robot, smoother, loop);
  refit_numbers(state);
  return state.result.model.Phi - loop.model.Phi;
}

}  // namespace shapeid::diagnosis
