#include "shapeid/diagnosis/slowness.hpp"

#include <algorithm>
#include <cmath>

#include "shapeid/diagnosis/spectrum.hpp"

namespace shapeid::diagnosis {
namespace {

// Shares of the cutoff. Above a half the filter begins to take noise away.
constexpr double slow_below = 0.2, noise_from = 0.25, noise_below = 0.5;
// Standard errors: chance reaches as many in one joint of some hundred thousand.
constexpr double believed_z = 4.5;
constexpr std::size_t fewest = 8;  // frequencies on either side
// Of the predicted torque: what filters, derivatives and rounding leave of a log without noise. No
// torque is measured as well.
constexpr double nothing = 1e-4;

void set_curve(const Spectrum& spectrum, Structure& structure) {
  constexpr std::size_t bins = 10;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::size_t from = bin * spectrum.power.size() / bins;
    const std::size_t to = (bin + 1) * spectrum.power.size() / bins;
    structure.at.push_back(spectrum.step * (0.5 * static_cast<double>(from + to - 1) + 1.0));
    structure.value.push_back(std::sqrt(spectrum.mean(from, to)));
  }
}

}  // namespace

std::vector<Structure> slow_remains(const Robot& robot, const Recording& recording,
                                    const Series& series, double cutoff,
                                    const std::vector<double>& noise) {
  std::vector<Structure> found;
  const std::vector<double> time = times(recording, series);
  if (time.size() < fewest) return found;
  const double step = usual_step(time);
  const Eigen::VectorXd rms = series.rms(), predicted = row_rms(series.predicted, series.counted);
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    if (rms[row] < nothing * predicted[row]) continue;
    const Eigen::VectorXd y = centred(series, series.residual, row);
    const Spectrum power = spectrum(time, y, noise_below * cutoff);
    const std::size_t low_end = power.at(slow_below * cutoff), from = power.at(noise_from * cutoff);
    const std::size_t end = power.power.size();
    if (low_end < fewest || end - from < fewest) continue;
    const double low = power.mean(0, low_end);
    // The logarithm of a mean of n exponential numbers has a standard deviation of 1 / sqrt(n).
    // Where only a share of the duration counts, that share of them is independent.
    const auto counted = static_cast<double>(series.counted.row(row).count());
    const double share = counted * step / (time.back() - time.front() + step);
    const double error = std::sqrt(
        (1.0 / static_cast<double>(low_end) + 1.0 / static_cast<double>(end - from)) / share);
    // In a spectrum what does not count is zero.
    const double of_torque =
        noise[static_cast<std::size_t>(j)] / step * counted / static_cast<double>(time.size());
    // The other one if this is not a number.
    const double quiet = std::fmin(power.mean(from, end), of_torque);
    const double z = std::log(low / quiet) / error;
    if (!(z > believed_z)) continue;
    Structure structure;
    structure.joint = robot.joint(j).name;
    structure.variable = slow;
    const double all = y.squaredNorm() / static_cast<double>(time.size());
    structure.share = std::clamp(2.0 * (low - quiet) * power.every * static_cast<double>(low_end) /
                                     static_cast<double>(time.size()) / all,
                                 0.0, 1.0);
    structure.t = z;
    set_curve(power, structure);
    found.push_back(structure);
  }
  return found;
}

}  // namespace shapeid::diagnosis
