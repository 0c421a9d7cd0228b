// Butterworth low-pass filters as second-order sections, designed by the bilinear transform, with
// their gain and group delay in closed form (docs/derivations/filtering.md).
#pragma once

#include <Eigen/Core>

#include <string_view>
#include <vector>

namespace shapeid {

/// H(z) = (b0 + b1 / z + b2 / z^2) / (1 + a1 / z + a2 / z^2)
struct Section {
  double b0, b1, b2, a1, a2;
};

/// A low-pass of unit gain at zero frequency and -3 dB at the cutoff, for one pass.
class Butterworth {
 public:
  /// `order` 1 to 8; `cutoff` and `rate` in Hz with 0 < cutoff < rate / 2. Throws InputError.
  Butterworth(int order, double cutoff, double rate);

  [[nodiscard]] const std::vector<Section>& sections() const { return sections_; }
  /// |H| at a frequency in Hz.
  [[nodiscard]] double gain(double frequency) const;
  /// -d(phase)/d(omega) at a frequency in Hz, in s.
  [[nodiscard]] double group_delay(double frequency) const;
  /// After how many samples a transient has decayed to `fraction` of itself, from the slowest pole.
  [[nodiscard]] Eigen::Index samples_to_decay(double fraction) const;

 private:
  /// Frequency on the axis of the analog prototype, where the cutoff is at one.
  [[nodiscard]] double prototype_frequency(double frequency) const;

  int order_;
  double rate_;
  double K_;  ///< tan(pi cutoff / rate)
  std::vector<Section> sections_;
};

/// Throws InputError that names the option by which the cutoff was chosen if there is no filter
/// with it; Hz.
void check_cutoff(std::string_view option, double cutoff, double rate);

/// Of each of the passes that go over a log.
inline constexpr int log_filter_order = 2;

/// Of white noise, the root mean square that two passes over a log leave, over that of what they
/// take away; `cutoff` and `rate` in Hz, as for Butterworth.
[[nodiscard]] double noise_left_over_taken(double cutoff, double rate);

/// Two passes of second order leave of white noise the power in this share of the cutoff's band:
/// the integral of 1 / (1 + x^4)^2 from zero on, 3 pi / (8 sqrt 2).
inline constexpr double band_of_two_passes = 0.833;

/// Runs many channels through a filter, one sample at a time.
class FilterState {
 public:
  FilterState(const Butterworth& design, Eigen::Index channels);

  /// As if the input had been `x` for ever (one entry a channel).
  void settle(const Eigen::VectorXd& x);
  /// The next output.
  [[nodiscard]] Eigen::VectorXd step(const Eigen::VectorXd& x);

  /// All that is remembered, for a checkpoint.
  template <class Archive>
  void state(Archive& archive) {
    archive("first", first_);
    archive("second", second_);
  }

 private:
  std::vector<Section> sections_;
  Eigen::MatrixXd first_, second_;  ///< transposed direct form II, channels x sections
};

}  // namespace shapeid
