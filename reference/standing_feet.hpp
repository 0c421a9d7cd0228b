// What feet that stand say of the gyro, and of the labels that say so.
#pragma once

#include <array>
#include <cstddef>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"
#include "shapeid/models/signed_axes.hpp"
#include "shapeid/reference/contact.hpp"

namespace shapeid::reference {

/// Of each contact point its place and its velocity by the joints alone (as if the gyro read
/// nothing), base axes, less the mean of those that touch; some must.
[[nodiscard]] ContactMotions against_stance(const Robot& robot, const Sample& sample);

/// Feet that stand do not move against each other: with r their places in base axes and u their
/// velocities by the joints alone, omega x (r_i - r_k) + u_i - u_k = 0. That needs no inertia, and
/// tells a gyro in degrees per second, or about other axes, and labels of feet that do not stand.
/// Sums alone are kept. The robot must outlive this.
class StandingFeet {
 public:
  explicit StandingFeet(const Robot& robot) : robot_(&robot) {}

  /// Samples in which fewer than two contacts touch say nothing.
  void add(const Sample& sample);

  /// Throws Refusal, where enough was seen to say so:
  ///  * "imu-axes": standing feet that stand still by the gyro as it is, or without any, and not by
  ///    one of another unit or with other axes, are few beside those of which it is the other way
  ///    round, which are a part of all, or are many stances, in which some of all stand still;
  ///  * "contact-labels": while others are in the air, feet that are declared to stand move against
  ///    each other about as fast as these.
  void judge();

 private:
  /// Ways to read a gyro: the 48 exchanges and signs of axes, as logged first, in rad/s and then in
  /// degrees per second; the last is that it reads nothing.
  static constexpr std::size_t readings = 2 * signed_axes_count + 1;
  /// What is so by a reading and not by another one, and the other way round.
  struct Difference {
    std::size_t gained = 0, lost = 0;
    void count(bool by_this, bool by_other) {
      if (by_this && !by_other) ++gained;
      if (by_other && !by_this) ++lost;
    }
  };
  /// Feet of samples that stand still; blocks of time in which more of them do.
  struct Comparison {
    Difference feet, blocks;
    [[nodiscard]] bool tells(std::size_t standing_count) const;
  };

  void close_block();
  void judge_gyro() const;
  void judge_labels() const;

  const Robot* robot_;
  std::array<std::size_t, readings> still_{}, still_in_block_{};
  std::array<Comparison, readings> from_logged_{}, from_none_{};
  double block_begins_ = 0.0;  ///< s
  std::size_t standing_count_ = 0;
  /// (m/s)^2, against the mean of the feet that stand, in samples in which some do not.
  double standing_ = 0.0, flying_ = 0.0;
  std::size_t beside_flying_count_ = 0, flying_count_ = 0;
};

}  // namespace shapeid::reference
