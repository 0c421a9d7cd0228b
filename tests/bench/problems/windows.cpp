#include "shapeid/tests/bench/problems/windows.hpp"

#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/reference/window.hpp"
#include "shapeid/tests/support/load_problem.hpp"

namespace shapeid::bench {
namespace {

const std::string robots = SHAPEID_SOURCE_DIR "/models/robots/quadruped";

Robot read_quadruped() {
  Robot robot = read_urdf(robots + ".urdf").robot;
  static_cast<void>(read_robot_yaml(robots + ".robot.yaml", robot));
  return robot;
}

}  // namespace

const Robot& quadruped() {
  static const Robot robot = read_quadruped();
  return robot;
}

BodyModel base_shapes() { return read_shapes_yaml(robots + ".shapes.yaml", quadruped()); }
BodyModel base_points() { return read_shapes_yaml(robots + ".points.yaml", quadruped()); }

Eigen::VectorXd some_truth(std::uint64_t seed) {
  test::Draw draw(seed);
  const BodyModel model = base_shapes();
  Eigen::VectorXd m(static_cast<Eigen::Index>(model.shapes.size()));
  for (double& mass : m) mass = draw.between(0.0, 1.0) < 0.3 ? 0.0 : draw.between(0.1, 1.2);
  return all_parameters(model, shape_columns(model) * m);
}

std::vector<DenseProblem> base_windows(const BodyModel& model, SeedSet seeds, test::Noise noise,
                                       Density density, int sequences, int windows) {
  std::vector<DenseProblem> all;
  for (int k = 0; k < sequences; ++k) {
    const std::uint64_t seed = seed_of(seeds, static_cast<std::uint64_t>(k));
    const std::size_t count = window_samples * static_cast<std::size_t>(windows);
    const std::vector<Sample> samples =
        test::trot(quadruped(), some_truth(seed), seed, count, noise);
    reference::Window window(quadruped(), model, ContactTreatment::project,
                             Eigen::VectorXd::Ones(quadruped().dof()));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      window.add(samples[i]);
      if (window.samples() < window_samples) continue;
      all.push_back(compressed(window.problem(model), model, density));
      all.back().follows = i >= window_samples;
      window.clear();
    }
  }
  return all;
}

}  // namespace shapeid::bench
