#include "shapeid/tests/diagnosis/arm.hpp"

#include <cmath>
#include <random>

#include "shapeid/diagnosis/effects.hpp"
#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::test {
namespace {

using diagnosis::Recording;

constexpr double rate = 100.0;

Sample motion(double t, std::uint32_t seed) {
  Sample s;
  s.time = t;
  s.q.setZero(3);
  s.dq.setZero(3);
  s.ddq.setZero(3);
  s.tau.setZero(3);
  for (int j = 0; j < 3; ++j) {
    for (int k = 1; k <= 4; ++k) {
      const double w = 2.0 * 3.1 * 0.11 * k * (1.0 + 0.13 * j) + 0.05 * k;
      const double phase = 1.7 * j + 0.9 * k * k + 0.37 * seed, size = 0.9 / k;
      s.q[j] += size * std::sin(w * t + phase);
      s.dq[j] += size * w * std::cos(w * t + phase);
      s.ddq[j] -= size * w * w * std::sin(w * t + phase);
    }
  }
  return s;
}

}  // namespace

Robot arm() {
  Robot robot;
  robot.name = "arm";
  robot.root = Root::fixed;
  robot.links.resize(4);
  robot.links[0].name = "root";
  const std::array<Eigen::Vector3d, 3> axes = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY(),
                                               Eigen::Vector3d::UnitY()};
  for (int i = 1; i < 4; ++i) {
    Link& link = robot.links[static_cast<std::size_t>(i)];
    link.name = "link" + std::to_string(i);
    link.parent = i - 1;
    link.joint.name = "joint" + std::to_string(i);
    link.joint.axis = axes[static_cast<std::size_t>(i) - 1];
    if (i > 1) link.joint.placement.translation() = Eigen::Vector3d(0.05, 0.0, 0.3);
    const double mass = 4.0 - i;
    Eigen::Matrix3d tensor;
    tensor << 0.02, 0.001, -0.002, 0.001, 0.025, 0.003, -0.002, 0.003, 0.01;
    link.inertia = from_centre(mass, {0.02, -0.01 * i, 0.14}, mass * 0.4 * tensor);
  }
  return robot;
}

Recording moved_as_arm(const Robot& robot, const std::vector<diagnosis::AppliedEffect>& effects) {
  const Recording log = record({});
  std::vector<Sample> samples = log.samples();
  const diagnosis::RichModel truth{stacked_parameters(robot), effects};
  const diagnosis::Viewer viewer(robot, ContactTreatment::ignore, effects);
  for (const std::size_t i : log.usable(1)) {
    samples[i].tau = diagnosis::predict(viewer, viewer.view(log, i), truth).force;
  }
  return {samples, rate};
}

Recording record(const ArmLog& log) {
  std::vector<Sample> samples;
  const auto count = static_cast<int>(log.seconds * rate);
  samples.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) samples.push_back(motion(k / rate, log.seed));
  const Recording bare(samples, rate);
  const Robot robot = arm();
  const diagnosis::RichModel truth{stacked_parameters(robot), log.effects};
  const diagnosis::Viewer viewer(robot, ContactTreatment::ignore, log.effects);
  std::mt19937 generator(log.seed);
  std::normal_distribution<double> normal;  // of a spread of zero it is undefined
  for (const std::size_t i : bare.usable(1)) {
    const diagnosis::View view = viewer.view(bare, i);
    samples[i].tau = diagnosis::predict(viewer, view, truth).force;
    for (double& tau : samples[i].tau) tau += log.noise * normal(generator);
  }
  // Samples at the ends have no torque: they are no part of the log.
  const std::vector<std::size_t> usable = bare.usable(1);
  return {std::vector<Sample>(samples.begin() + static_cast<std::ptrdiff_t>(usable.front()),
                              samples.begin() + static_cast<std::ptrdiff_t>(usable.back()) + 1),
          rate};
}

Recording record(const ArmLog& log, const std::function<void(std::vector<Sample>&)>& change) {
  const Recording clean = record(log);
  std::vector<Sample> samples = clean.samples();
  change(samples);
  return {std::move(samples), clean.rate()};
}

Recording before_a_gear(double (*lead)(double torque)) {
  const std::vector<Sample> quiet = record({{}, 20.0, 0.0}).samples();
  return record({}, [&](std::vector<Sample>& samples) {
    const auto at = [&](std::size_t i) { return lead(quiet[i].tau[1]); };
    for (std::size_t i = 2; i + 2 < samples.size(); ++i) {  // as a filter would leave it
      const double h = 0.5 * (samples[i + 2].time - samples[i - 2].time);
      samples[i].q[1] += at(i);
      samples[i].dq[1] += (at(i + 2) - at(i - 2)) / (2.0 * h);
      samples[i].ddq[1] += (at(i + 2) - 2.0 * at(i) + at(i - 2)) / (h * h);
    }
  });
}

diagnosis::LoopSettings arm_settings() {
  const Robot robot = arm();
  diagnosis::LoopSettings settings;
  settings.rows = ContactTreatment::ignore;
  settings.shapes = diagnosis::generous_regions(robot, {1, 2, 3});
  settings.expected_mass = 6.0;
  settings.size = Eigen::VectorXd::Ones(40);
  settings.size.tail(30) =
      reference::sizes_of_links(settings.shapes, Eigen::Vector3d::Constant(2.0));
  settings.stride = 2;
  return settings;
}

diagnosis::LoopResult loop_of(const Recording& log) {
  return diagnosis::close_loop(arm(), log, nullptr, arm_settings());
}

diagnosis::AppliedEffect effect(const std::string& id, int site, std::vector<double> value) {
  diagnosis::AppliedEffect applied = diagnosis::at_start(*diagnosis::find_effect(id), site);
  applied.value = Eigen::Map<const Eigen::VectorXd>(value.data(), std::ssize(value));
  return applied;
}

std::vector<std::string> found_ids(const diagnosis::LoopResult& result) {
  std::vector<std::string> ids;
  for (const diagnosis::Found& f : result.found) ids.push_back(f.id);
  return ids;
}

}  // namespace shapeid::test
