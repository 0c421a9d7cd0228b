#include "shapeid/models/butterworth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "shapeid/models/error.hpp"

namespace shapeid {
namespace {

using std::numbers::pi;

/// Damping q of the k-th conjugate pair 1 / (s^2 + q s + 1) of the prototype, k from 1.
double damping(int order, int k) { return 2.0 * std::sin((2 * k - 1) * pi / (2 * order)); }

bool has_filter(double cutoff, double rate) { return cutoff > 0.0 && cutoff < rate / 2.0; }

}  // namespace

void check_cutoff(std::string_view option, double cutoff, double rate) {
  if (has_filter(cutoff, rate)) return;
  throw InputError(
      fmt::format("{} {:g}: a filter of {:g} Hz for data at {:g} Hz", option, cutoff, cutoff, rate),
      fmt::format("choose a cutoff between 0 and {:g} Hz, half the rate", rate / 2.0));
}

Butterworth::Butterworth(int order, double cutoff, double rate)
    : order_(order), rate_(rate), K_(std::tan(pi * cutoff / rate)) {
  constexpr int highest_order = 8;
  if (order < 1 || order > highest_order) {
    throw InputError(fmt::format("filter of order {}", order),
                     fmt::format("choose an order from 1 to {}", highest_order));
  }
  if (!has_filter(cutoff, rate)) {
    throw InputError(fmt::format("cutoff of {:g} Hz for data at {:g} Hz", cutoff, rate),
                     fmt::format("choose a cutoff between 0 and {:g} Hz", rate / 2.0));
  }
  // s = (1 - 1/z) / (K (1 + 1/z)) takes the cutoff of the prototype to that of the filter.
  for (int k = 1; k <= order / 2; ++k) {
    const double q = damping(order, k);
    const double a0 = 1.0 + q * K_ + K_ * K_;
    const double b = K_ * K_ / a0;
    sections_.push_back({b, 2.0 * b, b, 2.0 * (K_ * K_ - 1.0) / a0, (1.0 - q * K_ + K_ * K_) / a0});
  }
  if (order % 2 == 1) {
    const double b = K_ / (1.0 + K_);
    sections_.push_back({b, b, 0.0, (K_ - 1.0) / (1.0 + K_), 0.0});
  }
}

double Butterworth::prototype_frequency(double frequency) const {
  return std::tan(pi * frequency / rate_) / K_;
}

double Butterworth::gain(double frequency) const {
  return 1.0 / std::sqrt(1.0 + std::pow(prototype_frequency(frequency), 2 * order_));
}

double Butterworth::group_delay(double frequency) const {
  const double w = prototype_frequency(frequency);
  double delay = order_ % 2 == 1 ? 1.0 / (1.0 + w * w) : 0.0;
  for (int k = 1; k <= order_ / 2; ++k) {
    const double q = damping(order_, k);
    delay += q * (1.0 + w * w) / (std::pow(1.0 - w * w, 2) + q * q * w * w);
  }
  const double stretch = (1.0 + std::pow(K_ * w, 2)) / (2.0 * rate_ * K_);  // dw / d omega
  return delay * stretch;
}

Eigen::Index Butterworth::samples_to_decay(double fraction) const {
  double slowest = 0.0;
  for (const Section& s : sections_) {
    const std::complex<double> root = std::sqrt(std::complex(s.a1 * s.a1 / 4.0 - s.a2));
    slowest = std::max(slowest, std::abs(std::abs(s.a1) / 2.0 + root));
  }
  // Far below the rate a pole rounds to one: nothing decays, and no log is as long as that.
  constexpr double longest = 1e12;
  if (!(slowest < 1.0)) return static_cast<Eigen::Index>(longest);
  // All poles at zero: forgotten at once.
  const double samples = std::ceil(std::log(fraction) / std::log(slowest));
  return static_cast<Eigen::Index>(std::clamp(samples, 1.0, longest));
}

double noise_left_over_taken(double cutoff, double rate) {
  const Butterworth filter(log_filter_order, cutoff, rate);
  // Sums over the band, as fine as the filter's edge asks for.
  const double step = std::min(0.5 * rate / 1000.0, 0.01 * cutoff);
  double left = 0.0, taken = 0.0;
  const int steps = static_cast<int>(std::ceil(0.5 * rate / step - 0.5));
  for (int i = 0; i < steps; ++i) {
    const double gain = std::pow(filter.gain((i + 0.5) * step), 2);  // of both passes
    left += gain * gain;
    taken += (1.0 - gain) * (1.0 - gain);
  }
  return std::sqrt(left / taken);
}

FilterState::FilterState(const Butterworth& design, Eigen::Index channels)
    : sections_(design.sections()),
      first_(Eigen::MatrixXd::Zero(channels, static_cast<Eigen::Index>(sections_.size()))),
      second_(first_) {}

void FilterState::settle(const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    const auto column = static_cast<Eigen::Index>(i);
    first_.col(column) = (1.0 - s.b0) * x;  // every section has unit gain: its output is x too
    second_.col(column) = (s.b2 - s.a2) * x;
  }
}

Eigen::VectorXd FilterState::step(const Eigen::VectorXd& x) {
  Eigen::VectorXd in = x;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const Section& s = sections_[i];
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd out = s.b0 * in + first_.col(column);
    first_.col(column) = s.b1 * in - s.a1 * out + second_.col(column);
    second_.col(column) = s.b2 * in - s.a2 * out;
    in = out;
  }
  return in;
}

}  // namespace shapeid
