#include "shapeid/tests/recovery/quadruped.hpp"

#include <stdexcept>
#include <string>

#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::test {

Quadruped bundled_quadruped() {
  const std::string path = SHAPEID_SOURCE_DIR "/models/robots/quadruped.";
  Quadruped result;
  result.robot = read_urdf(path + "urdf").robot;
  result.notes = read_robot_yaml(path + "robot.yaml", result.robot);
  result.base = read_shapes_yaml(path + "shapes.yaml", result.robot);
  return result;
}

std::vector<SimulatedSample> trot(const Robot& robot, const Trot& wanted) {
  SimulationOptions options;
  options.duration = wanted.seconds;
  options.rate = wanted.rate;
  options.seed = wanted.seed;
  options.load = wanted.load;
  std::vector<SimulatedSample> samples;
  const SimulationReport report =
      simulate(robot, options, [&](const SimulatedSample& sample) { samples.push_back(sample); });
  if (report.fell_at) throw std::runtime_error("the simulated robot fell: pin another seed");
  return samples;
}

BodyModel divided_cuboids(const Robot& robot, const std::vector<int>& links, int parts) {
  Robot bare = robot;  // without collision bodies the default is the cuboid of the inertia
  for (Link& link : bare.links) link.collision.clear();
  BodyModel model = default_shapes(bare, links);
  for (int count = 1; count < parts; count *= 2) {
    std::vector<SoughtShape> halves;
    for (const SoughtShape& whole : model.shapes) {
      const auto [lower, upper] = divide(whole.shape);
      halves.push_back({whole.link, lower, whole.id + ".0"});
      halves.push_back({whole.link, upper, whole.id + ".1"});
    }
    model.shapes = std::move(halves);
  }
  return model;
}

}  // namespace shapeid::test
