#include "shapeid/diagnosis/torque_noise.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "shapeid/diagnosis/same_time.hpp"
#include "shapeid/diagnosis/spectrum.hpp"
#include "shapeid/models/butterworth.hpp"

namespace shapeid::diagnosis {
namespace {

// Shares of the cutoff.
constexpr double from = 1.5, below = 2.0;
constexpr std::size_t fewest = 8;  // frequencies

/// Torques (joints x samples) that the rough filter leaves and the smooth one takes, and which of
/// them count. The difference is looked at, not the torque: gaps in time would spread the motion's
/// own torque, which is a thousand times the noise, over all frequencies.
struct Fast {
  std::vector<double> time;
  Eigen::MatrixXd torque;
  Eigen::ArrayXXd counts;  ///< one or zero
};

/// What the links need where nothing moves and the accelerometer reads this, dof: how a change of
/// its reading changes what they need.
Eigen::VectorXd carried(const Viewer& viewer, const View& view, const Eigen::Vector3d& reading,
                        const Eigen::VectorXd& Phi) {
  Sample still = view.sample;
  still.dq.setZero();
  still.ddq.setZero();
  still.tau.setZero();
  still.base_angular_velocity.setZero();
  still.base_angular_acceleration.setZero();
  still.base_specific_force = reading;
  return viewer.links(viewer.scene(std::move(still), view.surroundings), Phi);
}

Fast fast_torque(const Viewer& viewer, const TwoFilters& log, const Eigen::VectorXd& Phi,
                 std::size_t stride) {
  const Robot& robot = viewer.robot();
  const std::vector<std::size_t> usable = log.smooth.usable(stride);
  Fast fast{{},
            Eigen::MatrixXd(robot.joint_count(), std::ssize(usable)),
            Eigen::ArrayXXd(robot.joint_count(), std::ssize(usable))};
  for (const std::size_t index : usable) {
    const double time = log.smooth[index].time;
    const Sample* rough = sample_at(log.rough, time);
    if (rough == nullptr) continue;
    const View view = viewer.view(log.smooth, index);
    Eigen::VectorXd difference = Eigen::VectorXd::Zero(robot.dof());
    difference.tail(robot.joint_count()) = rough->tau - log.smooth[index].tau;
    if (robot.root == Root::floating) {
      difference -= carried(
          viewer, view, rough->base_specific_force - log.smooth[index].base_specific_force, Phi);
    }
    const auto column = std::ssize(fast.time);
    fast.torque.col(column) =
        beyond_contacts(viewer, view.J, difference).bottomRows(robot.joint_count());
    fast.counts.col(column) =
        counted_rows(viewer, log.smooth, index, view).tail(robot.joint_count()).cast<double>();
    fast.time.push_back(time);
  }
  fast.torque.conservativeResize(Eigen::NoChange, std::ssize(fast.time));
  fast.counts.conservativeResize(Eigen::NoChange, std::ssize(fast.time));
  return fast;
}

}  // namespace

std::vector<double> torque_noise(const Viewer& viewer, const TwoFilters& log,
                                 const Eigen::VectorXd& Phi, std::size_t stride) {
  const auto joints = static_cast<std::size_t>(viewer.robot().joint_count());
  std::vector<double> noise(joints, std::numeric_limits<double>::quiet_NaN());
  const Fast fast = fast_torque(viewer, log, Phi, stride);
  if (fast.time.size() < fewest) return noise;
  const double step = usual_step(fast.time);
  const Butterworth taken(log_filter_order, log.cutoff, log.smooth.rate());
  const Butterworth left(log_filter_order, log.rough_cutoff, log.smooth.rate());
  for (std::size_t j = 0; j < joints; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const Eigen::ArrayXd counts = fast.counts.row(row).transpose();
    const Spectrum power =
        spectrum(fast.time, (fast.torque.row(row).transpose().array() * counts).matrix(),
                 below * log.cutoff);
    const std::size_t first = power.at(from * log.cutoff), end = power.power.size();
    if (end - first < fewest || !(counts.sum() > 0.0)) continue;
    double sum = 0.0;
    for (std::size_t k = first; k < end; ++k) {
      const double frequency = power.step * static_cast<double>(k + 1);
      // Two passes each.
      const double gain = std::pow(left.gain(frequency), 2) - std::pow(taken.gain(frequency), 2);
      sum += power.power[k] / (gain * gain);
    }
    const double share = counts.mean();
    noise[j] = sum / static_cast<double>(end - first) / share * step;
  }
  return noise;
}

}  // namespace shapeid::diagnosis
