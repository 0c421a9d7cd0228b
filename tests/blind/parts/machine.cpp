#include "shapeid/tests/blind/parts/machine.hpp"

#include "shapeid/models/simbody/random.hpp"
#include "shapeid/models/urdf.hpp"

namespace shapeid::blind {

Machine arm() {
  Machine m;
  m.name = "arm";
  m.urdf = SHAPEID_SOURCE_DIR "/tests/blind/arm.urdf";
  m.yaml = SHAPEID_SOURCE_DIR "/tests/blind/arm.robot.yaml";
  UrdfOptions fixed;
  fixed.root = Root::fixed;
  m.robot = read_urdf(m.urdf, fixed).robot;
  m.notes = read_robot_yaml(m.yaml, m.robot);
  m.free_links = {1, 2, 3, 4};
  m.rate = 500.0;
  m.cutoff = 15.0;
  return m;
}

Machine quadruped() {
  Machine m;
  m.name = "quadruped";
  m.urdf = SHAPEID_SOURCE_DIR "/models/robots/quadruped.urdf";
  m.yaml = SHAPEID_SOURCE_DIR "/models/robots/quadruped.robot.yaml";
  m.robot = read_urdf(m.urdf).robot;
  m.notes = read_robot_yaml(m.yaml, m.robot);
  m.free_links = {0};
  m.rate = 500.0;
  m.cutoff = 40.0;
  return m;
}

Machine machine(const std::string& name) { return name == "arm" ? arm() : quadruped(); }

std::vector<InertialParameters> wrong_inertias(const Machine& machine, std::uint64_t seed) {
  Random random(seed);
  // A CAD model's errors: a tenth of the mass and of each length, a centimetre.
  constexpr double relative = 0.1, shift = 0.01;
  std::vector<InertialParameters> wrong;
  for (const int link : machine.free_links) {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) T(i, k) += 0.5 * relative * random.normal();
      T(i, 3) = shift * random.normal();
    }
    const PseudoInertia sigma =
        pseudo_inertia(machine.robot.links[static_cast<std::size_t>(link)].inertia);
    // An affine map takes bodies to bodies.
    wrong.push_back(std::exp(relative * random.normal()) *
                    from_pseudo_inertia(T * sigma * T.transpose()));
  }
  return wrong;
}

Robot with_inertias(const Machine& machine, const std::vector<InertialParameters>& inertias) {
  Robot robot = machine.robot;
  for (std::size_t i = 0; i < inertias.size(); ++i) {
    robot.links[static_cast<std::size_t>(machine.free_links[i])].inertia = inertias[i];
  }
  return robot;
}

}  // namespace shapeid::blind
