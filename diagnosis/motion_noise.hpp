// Noise of motion: positions that were differentiated twice. Where it makes most of what remains,
// it is in the columns of every law as well, and agrees with some of them.
#pragma once

#include <vector>

#include "shapeid/diagnosis/loop.hpp"
#include "shapeid/diagnosis/series.hpp"
#include "shapeid/diagnosis/unexplained.hpp"

namespace shapeid::diagnosis {

/// A slower filter leaves a thirtieth of such noise, and of motion that is slower all.
inline constexpr double slower_by = 0.5;  // of the cutoff

/// Of what remains of each joint, the share that is faster than `slower_by` times the cutoff (Hz).
/// Of noise of torque that is less than half, of noise of motion nearly all. Zero where the series
/// cannot tell, and where the joint itself moves so fast that a slower filter would lose it.
[[nodiscard]] std::vector<double> fast_shares(const Robot& robot, const Recording& recording,
                                              const Series& series, double cutoff);

/// Whether so much is noise of motion: two thirds, beside noise of torque.
[[nodiscard]] bool is_noise_of_motion(double fast_share);

/// Logs with the settings that go with their filter. The smoother ones are the same behind a filter
/// of `slower_by` times the cutoff.
struct FilteredLogs {
  const Recording& log;
  const Recording* reference;  ///< may be null
  const LoopSettings& settings;
};

/// Takes back what was found and is noise of motion. Numbers that fit noisy accelerations come out
/// too small (errors in variables), and a law whose column goes with the motion makes up for that:
/// it predicts, and is no cause. What is slow loses nothing to a slower filter, and noise does, so
/// a cause gains a larger share of the error there; what gains less than half the share is taken
/// back, and the others' numbers are fitted anew; not a ripple that is lost there itself
/// (is_fast_ripple()). Returns it. Throws Refusal "too-short" as close_loop() does: a slower filter
/// leaves less of a log.
std::vector<Found> take_back_names(const Robot& robot, const FilteredLogs& logs,
                                   const FilteredLogs& smoother, LoopResult& loop);

/// Marks names that stand and are lost behind the slower filter: of the squared error that a cause
/// explains, much is left there, whatever else is, and little of what noise of motion has made a
/// name for. Ripples as above, and neither delays nor lags. Throws likewise.
void doubt_names(const Robot& robot, const FilteredLogs& logs, const FilteredLogs& smoother,
                 LoopResult& loop);

/// Takes back laws without a name at joints of which `fast_shares` is noise of motion, if the
/// smoother logs have none there; names are then questioned as these have it. Returns what was
/// taken back. Throws likewise.
std::vector<Stranger> take_back_noise(const Robot& robot, const FilteredLogs& smoother,
                                      const std::vector<double>& fast_shares, LoopResult& loop);

/// unexplained() of the smoother log, by the loop's model with its numbers fitted anew there: noise
/// of motion has spoilt these, too. Throws likewise.
[[nodiscard]] std::vector<Structure> unexplained_behind(const Robot& robot,
                                                        const FilteredLogs& smoother,
                                                        const LoopResult& loop);

/// 10 per link: how far the loop's inertial numbers move when all its numbers are fitted anew
/// behind the slower filter. Noise of motion, which it takes away, has spoilt them, and what a
/// filter makes of products is corrected to first order. Throws likewise.
[[nodiscard]] Eigen::VectorXd moves_behind(const Robot& robot, const FilteredLogs& smoother,
                                           const LoopResult& loop);

}  // namespace shapeid::diagnosis
