#include "shapeid/reference/standing_feet.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "shapeid/models/error.hpp"
#include "shapeid/models/signed_axes.hpp"

namespace shapeid::reference {
namespace {

// Feet of so many samples say something.
constexpr std::size_t enough = 50;
// s, about a stance of a trot: samples of one are no more than one opinion.
constexpr double block = 0.25;

/// What the gyro is multiplied with, reading by reading.
std::vector<Eigen::Matrix3d> all_readings() {
  constexpr double degree = std::numbers::pi / 180.0;
  std::vector<Eigen::Matrix3d> result;
  for (const double unit : {1.0, degree}) {
    for (const SignedAxes& axes : all_signed_axes()) result.emplace_back(unit * axes.matrix());
  }
  result.emplace_back(Eigen::Matrix3d::Zero());
  return result;
}

}  // namespace

ContactMotions against_stance(const Robot& robot, const Sample& sample) {
  ContactMotions feet = contact_motions(robot, sample);
  const auto standing =
      static_cast<double>(std::count(sample.in_contact.begin(), sample.in_contact.end(), true));
  Eigen::Vector3d mean_place = Eigen::Vector3d::Zero(), mean_velocity = Eigen::Vector3d::Zero();
  for (Eigen::Index c = 0; c < feet.place.cols(); ++c) {
    feet.velocity.col(c) -= sample.base_angular_velocity.cross(feet.place.col(c));
    if (!sample.in_contact[static_cast<std::size_t>(c)]) continue;
    mean_place += feet.place.col(c) / standing;
    mean_velocity += feet.velocity.col(c) / standing;
  }
  feet.place.colwise() -= mean_place;
  feet.velocity.colwise() -= mean_velocity;
  return feet;
}

void StandingFeet::add(const Sample& sample) {
  static const std::vector<Eigen::Matrix3d> reading = all_readings();
  const auto standing = std::count(sample.in_contact.begin(), sample.in_contact.end(), true);
  if (standing < 2) return;
  if (standing_count_ == 0) block_begins_ = sample.time;
  const double since = sample.time - block_begins_;
  if (!(since >= 0.0 && since < block)) {  // or another log begins
    close_block();
    block_begins_ = sample.time;
  }
  const ContactMotions feet = against_stance(*robot_, sample);
  const auto squared_speed = [&](Eigen::Index foot, const Eigen::Vector3d& omega) {
    return (omega.cross(feet.place.col(foot)) + feet.velocity.col(foot)).squaredNorm();
  };
  // Many feet slip for a part of their stance; those that do not tell the readings apart.
  constexpr double slow = 0.05;  // m/s
  for (Eigen::Index c = 0; c < feet.place.cols(); ++c) {
    const double as_logged = squared_speed(c, sample.base_angular_velocity);
    if (!sample.in_contact[static_cast<std::size_t>(c)]) {
      flying_ += as_logged;
      ++flying_count_;
      continue;
    }
    ++standing_count_;
    if (standing < feet.place.cols()) {
      standing_ += as_logged;
      ++beside_flying_count_;
    }
    std::array<bool, readings> is_still{};
    for (std::size_t k = 0; k < readings; ++k) {
      is_still[k] = squared_speed(c, reading[k] * sample.base_angular_velocity) < slow * slow;
    }
    for (std::size_t k = 0; k < readings; ++k) {
      if (is_still[k]) ++still_in_block_[k];
      from_logged_[k].feet.count(is_still[k], is_still.front());
      from_none_[k].feet.count(is_still[k], is_still.back());
    }
  }
}

void StandingFeet::close_block() {
  const auto more_than = [&](std::size_t k, std::size_t other) {
    return still_in_block_[k] > still_in_block_[other];
  };
  const auto count = [&](Comparison& c, std::size_t k, std::size_t other) {
    c.blocks.count(more_than(k, other), more_than(other, k));
  };
  for (std::size_t k = 0; k < readings; ++k) {
    count(from_logged_[k], k, 0);
    count(from_none_[k], k, readings - 1);
    still_[k] += still_in_block_[k];
  }
  still_in_block_.fill(0);
}

// Feet that slip, roll or are labelled wrongly stand still now and then by any reading, and in some
// stances more of them by a wrong one. Where most slip, the others are few, but of many stances.
bool StandingFeet::Comparison::tells(std::size_t standing_count) const {
  constexpr std::size_t times = 3, one_in = 20, many_blocks = 10;
  const bool is_clear = feet.gained > times * feet.lost && blocks.gained >= times * blocks.lost;
  return is_clear && (feet.gained > standing_count / one_in || blocks.gained >= many_blocks);
}

void StandingFeet::judge() {
  close_block();
  if (standing_count_ < enough) return;
  judge_gyro();
  judge_labels();
}

void StandingFeet::judge_gyro() const {
  const auto best = static_cast<std::size_t>(
      std::distance(still_.begin(), std::max_element(still_.begin(), still_.end())));
  const Comparison& from_logged = from_logged_[best];
  if (!from_logged.tells(standing_count_) || !from_none_[best].tells(standing_count_)) return;
  // Feet in the air that count as standing, as near a touch, are still for a moment by any reading.
  constexpr std::size_t one_in = 30;
  if (still_[best] * one_in < standing_count_) return;
  const auto percent = [&](std::size_t reading) {
    return 1e2 * static_cast<double>(still_[reading]) / static_cast<double>(standing_count_);
  };
  const SignedAxes& axes = all_signed_axes().at(best % signed_axes_count);
  std::vector<std::string> wrong;
  if (best >= signed_axes_count) wrong.emplace_back("its unit were degrees per second");
  if (best % signed_axes_count != 0) wrong.push_back("its axes were " + axes.words());
  throw Refusal("imu-axes",
                fmt::format("{:.1f} % of the standing feet stand still by the gyro as it is, and "
                            "{:.1f} % if {}, more in {} stretches of {} s and fewer in {}: turn "
                            "the IMU (robot.yaml: without it its axes are the base's), or the "
                            "gyro in the mapping; or legs are exchanged",
                            percent(0), percent(best), fmt::join(wrong, " and "),
                            from_logged.blocks.gained, block, from_logged.blocks.lost));
}

void StandingFeet::judge_labels() const {
  if (flying_count_ < enough) return;
  const double standing = std::sqrt(standing_ / static_cast<double>(beside_flying_count_));
  const double flying = std::sqrt(flying_ / static_cast<double>(flying_count_));
  // A foot in the air beside one that stands makes it 1; feet that slip at touchdown, a part of it.
  constexpr double alike = 0.7;
  if (!(standing > alike * flying)) return;
  throw Refusal("contact-labels",
                fmt::format("feet declared to stand move against each other at {:.2g} m/s, feet "
                            "declared in the air at {:.2g} m/s: the contacts, as they are logged "
                            "or were derived from the given masses, do not fit the motion",
                            standing, flying));
}

}  // namespace shapeid::reference
