#include "shapeid/tests/blind/parts/machine.hpp"

#include <charconv>
#include <optional>

#include "shapeid/models/error.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/models/text.hpp"
#include "shapeid/models/urdf.hpp"
#include "shapeid/tests/blind/parts/drawn.hpp"
#include "shapeid/tests/blind/parts/drawn_quadruped.hpp"

namespace shapeid::blind {
namespace {

Machine of_files(const std::string& urdf, const std::string& yaml, Root root) {
  constexpr std::size_t limit = 1U << 20U;
  Machine m;
  m.urdf = read_small_file(urdf, limit);
  m.yaml = read_small_file(yaml, limit);
  UrdfOptions options;
  options.root = root;
  m.robot = read_urdf(urdf, options).robot;
  m.notes = read_robot_yaml(yaml, m.robot);
  return m;
}

std::optional<std::uint64_t> seed_behind(const std::string& prefix, const std::string& name) {
  std::uint64_t seed = 0;
  if (!name.starts_with(prefix)) return std::nullopt;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + prefix.size(), end, seed);
  if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
  return seed;
}

}  // namespace

Machine arm() {
  const std::string folder = SHAPEID_SOURCE_DIR "/tests/blind/";
  Machine m = of_files(folder + "arm.urdf", folder + "arm.robot.yaml", Root::fixed);
  m.name = "arm";
  m.free_links = {1, 2, 3, 4};
  m.rate = 500.0;
  m.cutoff = 15.0;
  return m;
}

Machine quadruped() {
  const std::string folder = SHAPEID_SOURCE_DIR "/models/robots/";
  Machine m = of_files(folder + "quadruped.urdf", folder + "quadruped.robot.yaml", Root::floating);
  m.name = "quadruped";
  m.free_links = {0};
  m.rate = 500.0;
  m.cutoff = 40.0;
  return m;
}

Machine machine(const std::string& name) {
  if (name == "arm") return arm();
  if (name == "quadruped") return quadruped();
  if (const auto seed = seed_behind(drawn_prefix, name)) return drawn_arm(*seed);
  if (const auto seed = seed_behind(quadruped_prefix, name)) return drawn_quadruped(*seed);
  throw InputError("no robot is called " + name,
                   "arm, quadruped, or drawn or trotter and a number");
}

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
