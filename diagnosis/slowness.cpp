#include "shapeid/diagnosis/slowness.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace shapeid::diagnosis {
namespace {

// Shares of the cutoff. Above a half the filter begins to take noise away.
constexpr double slow_below = 0.2, noise_from = 0.25, noise_below = 0.5;
// Standard errors: chance reaches as many in one joint of some hundred thousand.
constexpr double least_z = 4.5;
constexpr std::size_t fewest = 8;  // frequencies on either side

/// Power of y, whose values that do not count are zero, at whole periods in its duration.
struct Spectrum {
  double step = 0.0;          ///< Hz; the first frequency, and from each to the next
  double every = 1.0;         ///< how many periods more the next one has
  std::vector<double> power;  ///< of unit variance in y: one on average

  [[nodiscard]] std::size_t at(double frequency) const {
    return std::min(static_cast<std::size_t>(std::max(frequency / step - 1.0, 0.0)), power.size());
  }
  [[nodiscard]] double mean(std::size_t from, std::size_t to) const {
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) sum += power[k];
    return sum / static_cast<double>(to - from);
  }
};

/// s: the usual one, whatever gaps there are.
double step_of(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

Spectrum spectrum(const std::vector<double>& time, const Eigen::VectorXd& y, double highest) {
  Spectrum result;
  const double duration = time.back() - time.front();
  if (!(duration > 0.0)) return result;
  // The cost grows with the square of the duration: of a long log not every frequency is looked at.
  constexpr double most_terms = 2e8;
  const double terms = highest * duration * static_cast<double>(time.size());
  result.every = std::max(1.0, std::ceil(terms / most_terms));
  result.step = result.every / duration;
  double f = result.step;
  while (f < highest) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < time.size(); ++i) {
      sum += std::polar(y[static_cast<Eigen::Index>(i)],
                        2.0 * std::numbers::pi * f * (time[i] - time.front()));
    }
    result.power.push_back(std::norm(sum) / static_cast<double>(time.size()));
    f += result.step;
  }
  return result;
}

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
                                    const Series& series, double cutoff) {
  std::vector<Structure> found;
  std::vector<double> time;
  for (const std::size_t i : series.index) time.push_back(recording[i].time);
  if (time.size() < fewest) return found;
  const double step = step_of(time);
  for (int j = 0; j < robot.joint_count(); ++j) {
    const Eigen::Index row = robot.base_dof() + j;
    const Eigen::ArrayXd counts = series.counted.row(row).cast<double>().transpose();
    Eigen::ArrayXd y = series.residual.row(row).transpose();
    y = (y - (y * counts).sum() / std::max(counts.sum(), 1.0)) * counts;
    const Spectrum power = spectrum(time, y, noise_below * cutoff);
    const std::size_t low_end = power.at(slow_below * cutoff), from = power.at(noise_from * cutoff);
    const std::size_t end = power.power.size();
    if (low_end < fewest || end - from < fewest) continue;
    const double low = power.mean(0, low_end), noise = power.mean(from, end);
    // The logarithm of a mean of n exponential numbers has a standard deviation of 1 / sqrt(n).
    // Where only a share of the duration counts, that share of them is independent.
    const double share = counts.sum() * step / (time.back() - time.front() + step);
    const double error = std::sqrt(
        (1.0 / static_cast<double>(low_end) + 1.0 / static_cast<double>(end - from)) / share);
    const double z = std::log(low / noise) / error;
    if (!(z > least_z)) continue;
    Structure structure;
    structure.joint = robot.joint(j).name;
    structure.variable = slow;
    const double all = y.square().sum() / static_cast<double>(time.size());
    structure.share = std::clamp(2.0 * (low - noise) * power.every * static_cast<double>(low_end) /
                                     static_cast<double>(time.size()) / all,
                                 0.0, 1.0);
    structure.t = z;
    set_curve(power, structure);
    found.push_back(structure);
  }
  return found;
}

}  // namespace shapeid::diagnosis
