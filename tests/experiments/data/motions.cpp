#include "shapeid/tests/experiments/data/motions.hpp"

#include <stdexcept>

#include "shapeid/models/log_writer.hpp"
#include "shapeid/models/motion.hpp"
#include "shapeid/models/simbody/sensors.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid::experiments {
namespace {

constexpr double begin = 1.0;  // s: the robot stands for 0.4 s, then trots
constexpr double spare = 0.3;  // s after the end: what a zero-phase filter loses there

/// Whether this sample is wanted. Half a sample's tolerance: times are multiples of 2 ms, rounded.
bool is_wanted(double time, double seconds) {
  constexpr double half = 0.001;
  return time > begin - half && time < begin + seconds - half;
}

}  // namespace

std::vector<Gait> gaits() {
  std::vector<Gait> all;
  all.push_back({"trot", "trot with varied speed, turn, height and tilt", {}});
  Gait steady{"steady", "the same trot, nothing varied", {}};
  steady.trot.vary_speed = steady.trot.vary_side = steady.trot.vary_turn = 0.0;
  steady.trot.vary_height = steady.trot.vary_tilt = 0.0;
  all.push_back(steady);
  Gait quick{"quick", "quick trot: period 0.3 s, 0.4 m/s", {}};
  quick.trot.period = 0.3;
  quick.trot.speed = 0.4;
  all.push_back(quick);
  Gait sway{"sway", "standing on four feet, swaying", {}};
  sway.trot.stand = 1e3;  // s: longer than any motion
  sway.trot.speed = sway.trot.vary_speed = sway.trot.vary_side = sway.trot.vary_turn = 0.0;
  sway.trot.vary_height = 0.03;
  sway.trot.vary_tilt = 0.15;
  all.push_back(sway);
  return all;
}

std::vector<SimulatedSample> simulated(const Robot& robot, const Wanted& wanted) {
  SimulationOptions options;
  options.duration = begin + wanted.seconds + spare;
  options.seed = wanted.seed;
  options.trot = wanted.gait.trot;
  options.load = wanted.load;
  std::vector<SimulatedSample> samples;
  const SimulationReport report =
      simulate(robot, options, [&](const SimulatedSample& sample) { samples.push_back(sample); });
  if (report.fell_at) throw std::runtime_error("the robot fell: " + wanted.gait.name);
  return samples;
}

std::vector<Sample> exact(const std::vector<SimulatedSample>& motion, double seconds) {
  std::vector<Sample> samples;
  for (const SimulatedSample& s : motion) {
    if (is_wanted(s.sample.time, seconds)) samples.push_back(s.sample);
  }
  return samples;
}

std::vector<Sample> measured(const test::Quadruped& quadruped,
                             const std::vector<SimulatedSample>& motion, double seconds,
                             const Sensing& sensing) {
  const test::ScratchFolder scratch;
  RobotNotes notes = quadruped.notes;
  for (auto& [channel, sigma] : notes.noise_sigma) sigma *= sensing.noise;
  Sensors sensors(quadruped.robot, notes, {sensing.noise > 0.0, false, sensing.seed});
  LogWriter log(scratch.path("log.csv"), sensors.columns());
  for (const SimulatedSample& s : motion) {
    log.write(sensors.measure(s.sample, Eigen::Quaterniond(s.state.base.linear())));
  }
  log.close();
  MotionOptions options;
  options.cutoff = sensing.cutoff;
  MotionReader reader(scratch.path("log.csv"), quadruped.robot, notes, std::nullopt, options);
  std::vector<Sample> samples;
  while (std::optional<Sample> sample = reader.next()) {
    if (is_wanted(sample->time, seconds)) samples.push_back(*std::move(sample));
  }
  return samples;
}

}  // namespace shapeid::experiments
