#include "shapeid/diagnosis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shapeid::diagnosis {

std::size_t Spectrum::at(double frequency) const {
  return std::min(static_cast<std::size_t>(std::max(frequency / step - 1.0, 0.0)), power.size());
}

double Spectrum::mean(std::size_t from, std::size_t to) const {
  double sum = 0.0;
  for (std::size_t k = from; k < to; ++k) sum += power[k];
  return sum / static_cast<double>(to - from);
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
  // From one frequency to the next each sample's phase turns by the same angle.
  const auto n = static_cast<Eigen::Index>(time.size());
  const Eigen::ArrayXd turn = 2.0 * std::numbers::pi * result.step *
                              (Eigen::Map<const Eigen::ArrayXd>(time.data(), n) - time.front());
  const Eigen::ArrayXd c = turn.cos(), s = turn.sin();
  Eigen::ArrayXd re = y.array(), im = Eigen::ArrayXd::Zero(n), before(n);
  double f = result.step;
  while (f < highest) {
    before = re;
    re = c * re - s * im;
    im = c * im + s * before;
    const double cosines = re.sum(), sines = im.sum();
    result.power.push_back((cosines * cosines + sines * sines) / static_cast<double>(n));
    f += result.step;
  }
  return result;
}

std::vector<double> times(const Recording& recording, const Series& series) {
  std::vector<double> time;
  for (const std::size_t i : series.index) time.push_back(recording[i].time);
  return time;
}

double usual_step(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace shapeid::diagnosis
