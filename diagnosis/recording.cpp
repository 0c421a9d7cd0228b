#include "shapeid/diagnosis/recording.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "shapeid/models/contact_margin.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::diagnosis {

Recording::Recording(std::vector<Sample> samples, double rate, std::vector<std::string> extra)
    : samples_(std::move(samples)),
      rate_(rate),
      independent_rate_(rate),
      origin_(samples_.empty() ? 0.0 : samples_.front().time),
      extra_(std::move(extra)),
      segment_begin_(samples_.size()),
      segment_end_(samples_.size()) {
  constexpr double step_of_grid = 1.5;   // a missing sample makes it two
  constexpr double longest_pause = 2.0;  // s that count: a stretch that is held out has as many
  std::size_t begin = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const bool last =
        i + 1 == samples_.size() || samples_[i + 1].time - samples_[i].time > step_of_grid / rate_;
    if (!last) continue;
    double before = 0.0;
    if (begin > 0) {
      before = recorded_.back() +
               std::min(samples_[begin].time - samples_[begin - 1].time, longest_pause);
    }
    for (std::size_t k = begin; k <= i; ++k) {
      segment_begin_[k] = begin;
      segment_end_[k] = i + 1;
      recorded_.push_back(before + samples_[k].time - samples_[begin].time);
    }
    begin = i + 1;
  }
  find_rests();
  find_turns();
  find_high_torques();
  find_down();
  find_touches();
}

void Recording::find_touches() {
  const Eigen::Index contacts = samples_.empty() ? 0 : std::ssize(samples_.front().in_contact);
  since_touch_.setConstant(contacts, std::ssize(samples_), std::numeric_limits<double>::infinity());
  until_touch_ = since_touch_;
  for (Eigen::Index c = 0; c < contacts; ++c) {
    const auto touches = [&](std::size_t i) {
      return samples_[i].in_contact[static_cast<std::size_t>(c)];
    };
    const auto along = [&](Eigen::MatrixXd& way, std::size_t i, std::size_t neighbour) {
      const double step = std::abs(samples_[neighbour].time - samples_[i].time);
      way(c, static_cast<Eigen::Index>(i)) =
          touches(i) ? 0.0 : way(c, static_cast<Eigen::Index>(neighbour)) + step;
    };
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      along(since_touch_, i, std::max(i, segment_begin_[i] + 1) - 1);
    }
    for (std::size_t i = samples_.size(); i-- > 0;) {
      along(until_touch_, i, std::min(i + 1, segment_end_[i] - 1));
    }
  }
}

void Recording::lengthen_contact(int contact, double before, double after) {
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (until_touch_(contact, at) <= before + time_rounding ||
        since_touch_(contact, at) <= after + time_rounding) {
      samples_[i].in_contact[static_cast<std::size_t>(contact)] = true;
    }
  }
  find_touches();
}

void Recording::extend_contacts(double before, double after) {
  if (declared_.empty()) {
    for (const Sample& s : samples_) declared_.push_back(s.in_contact);
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    for (Eigen::Index c = 0; c < until_touch_.rows(); ++c) {
      if (until_touch_(c, at) <= before + time_rounding ||
          since_touch_(c, at) <= after + time_rounding) {
        samples_[i].in_contact[static_cast<std::size_t>(c)] = true;
      }
    }
  }
}

Surroundings Recording::surroundings(std::size_t index) const {
  const auto at = static_cast<Eigen::Index>(index);
  return {elapsed(index), down(index), since_touch_.col(at), until_touch_.col(at)};
}

void Recording::find_down() {
  constexpr double seconds = 0.5;  // to either side
  const auto half = static_cast<std::size_t>(std::lround(seconds * rate_));
  down_.setZero(3, std::ssize(samples_));
  std::vector<Eigen::Quaterniond> attitude(samples_.size(), Eigen::Quaterniond::Identity());
  std::vector<Eigen::Vector3d> sum(samples_.size() + 1, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (segment_begin_[i] != i) {
      const Eigen::Vector3d turn =
          0.5 / rate_ * (samples_[i - 1].base_angular_velocity + samples_[i].base_angular_velocity);
      const double angle = turn.norm();
      const Eigen::Vector3d axis =
          angle > 0.0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
      attitude[i] = (attitude[i - 1] * Eigen::AngleAxisd(angle, axis)).normalized();
    }
    sum[i + 1] = sum[i] + attitude[i] * samples_[i].base_specific_force;
  }
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const std::size_t begin = std::max(segment_begin_[i], i - std::min(i, half));
    const std::size_t end = std::min(segment_end_[i], i + half + 1);
    down_.col(static_cast<Eigen::Index>(i)) =
        -(attitude[i].conjugate() * (sum[end] - sum[begin])).normalized();
  }
}

void Recording::find_high_torques() {
  const Eigen::Index joints = samples_.empty() ? 0 : samples_.front().tau.size();
  high_torque_.setZero(std::ssize(high_levels), joints);
  std::vector<double> sizes(samples_.size());
  for (Eigen::Index j = 0; j < joints; ++j) {
    std::transform(samples_.begin(), samples_.end(), sizes.begin(),
                   [&](const Sample& s) { return std::abs(s.tau[j]); });
    std::sort(sizes.begin(), sizes.end());
    for (std::size_t k = 0; k < high_levels.size(); ++k) {
      const double place = high_levels[k] * static_cast<double>(sizes.size() - 1);
      high_torque_(static_cast<Eigen::Index>(k), j) = sizes[static_cast<std::size_t>(place)];
    }
  }
}

void Recording::find_turns() {
  constexpr double share_of_range = 0.1;
  const Eigen::Index joints = samples_.empty() ? 0 : samples_.front().q.size();
  turned_.setZero(joints, std::ssize(samples_));
  for (Eigen::Index j = 0; j < joints; ++j) {
    const auto [least, most] =
        std::minmax_element(samples_.begin(), samples_.end(),
                            [&](const Sample& a, const Sample& b) { return a.q[j] < b.q[j]; });
    const double way = share_of_range * (most->q[j] - least->q[j]);
    if (!(way > 0.0)) continue;
    for (std::size_t i = 1; i < samples_.size(); ++i) {
      if (segment_begin_[i] == i) continue;  // nobody knows where it came from
      const auto at = static_cast<Eigen::Index>(i);
      // d turned = (dq - turned |dq|) / way, exactly over a step
      const double step = (samples_[i].q[j] - samples_[i - 1].q[j]) / way;
      const double side = step > 0.0 ? 1.0 : -1.0;
      turned_(j, at) = side + (turned_(j, at - 1) - side) * std::exp(-std::abs(step));
    }
  }
}

void Recording::find_rests() {
  constexpr double slow = 0.01;     // rad/s or m/s
  constexpr double seconds = 0.25;  // a motion that turns round is as slow for a moment, too
  const auto longest_turn = static_cast<std::size_t>(std::ceil(seconds * rate_));
  const Eigen::Index joints = samples_.empty() ? 0 : samples_.front().dq.size();
  at_rest_.setConstant(joints, std::ssize(samples_), false);
  for (Eigen::Index j = 0; j < joints; ++j) {
    for (std::size_t i = 0; i < samples_.size();) {
      std::size_t end = i;
      while (end < segment_end_[i] && std::abs(samples_[end].dq[j]) < slow) ++end;
      if (end > i + longest_turn) {
        at_rest_.row(j).segment(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(end - i)) =
            true;
      }
      i = std::max(end, i + 1);
    }
  }
}

/// Samples to either side that a shift and its cubic need.
std::size_t Recording::reach() const {
  return static_cast<std::size_t>(std::ceil(largest_shift * rate_)) + 2;
}

Violation Recording::why_not_shifted(std::size_t index, double dt) const {
  constexpr double rounding = 1e-12;  // s, of a few sums
  if (!surrounded(index, reach())) return "a sample without neighbours is shifted";
  if (!(std::abs(dt) <= largest_shift + rounding)) return "a sample is shifted too far";
  return std::nullopt;
}

std::vector<std::size_t> Recording::usable(std::size_t stride) const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < samples_.size(); i += stride) {
    if (surrounded(i, reach())) indices.push_back(i);
  }
  return indices;
}

Sample Recording::shifted(std::size_t index, double dt) const {
  SHAPEID_CONTRACT(why_not_shifted(index, dt));
  const double place = static_cast<double>(index) + dt * rate_;
  const auto before = static_cast<std::size_t>(std::floor(place));
  const double u = place - static_cast<double>(before);
  const std::size_t nearest = u < 0.5 ? before : before + 1;
  Sample result = samples_[nearest];
  if (!declared_.empty()) result.in_contact = declared_[nearest];
  if (u == 0.0) return result;
  // Lagrange's cubic through the samples at -1, 0, 1, 2.
  const std::array<double, 4> w = {
      -u * (u - 1.0) * (u - 2.0) / 6.0, (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
      -(u + 1.0) * u * (u - 2.0) / 2.0, (u + 1.0) * u * (u - 1.0) / 6.0};
  const auto mix = [&](const auto& member) {
    auto sum = (w[0] * member(samples_[before - 1])).eval();
    for (std::size_t k = 1; k < w.size(); ++k) sum += w[k] * member(samples_[before - 1 + k]);
    return sum;
  };
  result.time = samples_[index].time + dt;
  result.q = mix([](const Sample& s) -> const auto& { return s.q; });
  result.dq = mix([](const Sample& s) -> const auto& { return s.dq; });
  result.ddq = mix([](const Sample& s) -> const auto& { return s.ddq; });
  result.tau = mix([](const Sample& s) -> const auto& { return s.tau; });
  result.base_angular_velocity =
      mix([](const Sample& s) -> const auto& { return s.base_angular_velocity; });
  result.base_angular_acceleration =
      mix([](const Sample& s) -> const auto& { return s.base_angular_acceleration; });
  result.base_specific_force =
      mix([](const Sample& s) -> const auto& { return s.base_specific_force; });
  return result;
}

}  // namespace shapeid::diagnosis
