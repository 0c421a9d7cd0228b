#include "shapeid/tests/diagnosis/trot.hpp"

#include <utility>

#include "shapeid/diagnosis/regions.hpp"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/identify.hpp"

namespace shapeid::test {

Robot quadruped() {
  const std::string files = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
  Robot robot = read_urdf(files + "urdf").robot;
  static_cast<void>(read_robot_yaml(files + "robot.yaml", robot));
  return robot;
}

Trot::Trot() : robot(quadruped()) {
  SimulationOptions options;
  options.duration = 6.0;
  Random random(7);
  simulate(robot, options, [&](const SimulatedSample& s) {
    samples.push_back(s.sample);
    attitude.emplace_back(s.state.base.linear());
    constexpr double noise = 0.03;  // N m
    for (double& tau : samples.back().tau) tau += noise * random.normal();
  });
}

diagnosis::LoopSettings Trot::settings() const {
  diagnosis::LoopSettings settings;
  settings.size = Eigen::VectorXd::Ones(Eigen::Index{10} * robot.link_count());
  settings.shapes.known = stacked_parameters(robot);
  settings.stride = 4;
  return settings;
}

diagnosis::LoopSettings Trot::settings_for_base() const {
  diagnosis::LoopSettings settings = this->settings();
  settings.shapes = diagnosis::generous_regions(robot, {0});
  settings.expected_mass = robot.links[0].inertia.mass();
  settings.size.head(10) = reference::natural_sizes(settings.shapes, settings.expected_mass);
  return settings;
}

diagnosis::Recording Trot::told(std::size_t foot, double late, double early) const {
  std::vector<Sample> told = samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!samples[i].in_contact[foot]) continue;
    for (const Sample& other : samples) {
      const double after = samples[i].time - other.time;
      if (other.in_contact[foot] || after > late || after < -early) continue;
      told[i].in_contact[foot] = false;
    }
  }
  return {std::move(told), rate};
}

}  // namespace shapeid::test
