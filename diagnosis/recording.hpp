// The samples of a log in memory, because effects look at neighbours and fits go over them often.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/diagnosis/effect.hpp"
#include "shapeid/models/contract.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::diagnosis {

/// Shares of a log's samples below Recording::high_torque().
inline constexpr std::array high_levels = {0.8, 0.93, 0.98};

class Recording {
 public:
  /// Samples in the order of time, on a grid of `rate` Hz with gaps. `extra` names what
  /// Sample::extra holds.
  Recording(std::vector<Sample> samples, double rate, std::vector<std::string> extra = {});

  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }
  [[nodiscard]] const Sample& operator[](std::size_t index) const { return samples_[index]; }
  [[nodiscard]] double rate() const { return rate_; }
  /// Samples a second whose noise is independent: behind a filter fewer than `rate`.
  void set_independent_rate(double independent_rate) { independent_rate_ = independent_rate; }
  /// Of every stride-th sample.
  [[nodiscard]] double independent_share(std::size_t stride) const {
    return std::min(1.0, independent_rate_ * static_cast<double>(stride) / rate_);
  }
  [[nodiscard]] const std::vector<std::string>& extra() const { return extra_; }
  /// The time (s, as in the samples) at which the log began of which this is a part: parts of one
  /// log share it. Without it the first sample's.
  void set_origin(double time) { origin_ = time; }
  /// s since the log began
  [[nodiscard]] double elapsed(std::size_t index) const { return samples_[index].time - origin_; }
  /// s since the first sample; of a pause no more than two seconds count, for it is no data.
  [[nodiscard]] double recorded(std::size_t index) const { return recorded_[index]; }
  /// Of all samples.
  [[nodiscard]] double duration() const { return recorded_.empty() ? 0.0 : recorded_.back(); }

  /// The contact touches also for so long (s) before and after it is declared to.
  void lengthen_contact(int contact, double before, double after);

  /// All contacts count as touching also for so long (s) before and after they are declared to;
  /// what is declared stays: surroundings() and shifted() tell it.
  void extend_contacts(double before, double after);

  /// A force (dof) that counts as logged besides the torque, one a sample: what the filter took
  /// from it (filter_error()). Zero-length: none.
  void set_correction(std::vector<Eigen::VectorXd> correction) {
    correction_ = std::move(correction);
  }
  [[nodiscard]] Eigen::VectorXd correction(std::size_t index) const {
    return correction_.empty() ? Eigen::VectorXd() : correction_[index];
  }

  /// Every stride-th sample that has neighbours for largest_shift on both sides. The same samples
  /// serve every hypothesis, also those that look at no neighbour.
  [[nodiscard]] std::vector<std::size_t> usable(std::size_t stride) const;
  /// The stride of about so many samples, evenly: for coarse questions.
  [[nodiscard]] std::size_t stride_of(std::size_t count) const {
    return std::max<std::size_t>(1, samples_.size() / count);
  }

  /// The stride of another log whose samples are as far apart in time as with `stride` in this one.
  [[nodiscard]] std::size_t stride_for(const Recording& other, std::size_t stride) const {
    const double samples = static_cast<double>(stride) * other.rate_ / rate_;
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(samples)));
  }

  /// Whether so many samples go before, and follow, without a gap.
  [[nodiscard]] bool surrounded(std::size_t index, std::size_t samples) const {
    return index >= segment_begin_[index] + samples && index + samples < segment_end_[index];
  }

  /// Whether the joint stands still: slower than a hundredth of a radian (a centimetre) a second
  /// for a quarter of a second or longer.
  [[nodiscard]] bool at_rest(std::size_t index, Eigen::Index joint) const {
    return at_rest_(joint, static_cast<Eigen::Index>(index));
  }

  /// How far the joint has come since it turned round, in the direction of its motion: from -1 to
  /// 1, a tenth of its range being most of the way (what presses, winds up or creeps follows it).
  [[nodiscard]] double turned(std::size_t index, Eigen::Index joint) const {
    return turned_(joint, static_cast<Eigen::Index>(index));
  }

  /// What the joint's logged torque seldom exceeds: of high_levels[level] of the samples it is
  /// smaller.
  [[nodiscard]] double high_torque(std::size_t level, Eigen::Index joint) const {
    return high_torque_(static_cast<Eigen::Index>(level), joint);
  }

  /// Where gravity pulls, in base axes, of unit length: the specific force's mean over a second,
  /// turned along by the gyro, in which whole steps of a gait cancel. As the URDF has it on a fixed
  /// base.
  [[nodiscard]] Eigen::Vector3d down(std::size_t index) const {
    return down_.col(static_cast<Eigen::Index>(index));
  }

  [[nodiscard]] Surroundings surroundings(std::size_t index) const;

  /// The motion `dt` seconds after a usable sample, by the cubic through four neighbours. Contacts
  /// (as they are declared), forces and extras are those of the nearest sample. |dt| <=
  /// largest_shift.
  [[nodiscard]] Sample shifted(std::size_t index, double dt) const;
  /// Why that cannot be had; empty if it can.
  [[nodiscard]] Violation why_not_shifted(std::size_t index, double dt) const;

 private:
  [[nodiscard]] std::size_t reach() const;
  void find_rests();
  void find_turns();
  void find_high_torques();
  void find_down();
  void find_touches();

  std::vector<Sample> samples_;
  double rate_, independent_rate_, origin_;
  std::vector<std::string> extra_;
  std::vector<Eigen::VectorXd> correction_;
  std::vector<double> recorded_;             ///< s, of each sample
  std::vector<std::vector<bool>> declared_;  ///< contacts of each sample, if more count as touching
  std::vector<std::size_t> segment_begin_, segment_end_;        ///< of each sample's segment
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> at_rest_;  ///< joints x samples
  Eigen::ArrayXXd turned_;                                      ///< likewise
  Eigen::ArrayXXd high_torque_;                                 ///< levels x joints
  Eigen::Matrix3Xd down_;                                       ///< one a sample
  Eigen::MatrixXd since_touch_, until_touch_;                   ///< contacts x samples
};

}  // namespace shapeid::diagnosis
