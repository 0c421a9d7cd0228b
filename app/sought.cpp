#include "shapeid/app/sought.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "shapeid/app/option_checks.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/shapes_yaml.hpp"

namespace shapeid::app {
namespace {

std::vector<int> links_of(const SoughtLinks& sought, const RobotInputs& inputs) {
  const Robot& robot = inputs.robot;
  if (sought.whole_body) return moving_links(robot);
  if (!sought.free_links.empty()) return named_links(sought.free_links, robot);
  const std::string unused = inputs.of_floating_base();
  if (robot.root == Root::fixed && !unused.empty()) {
    throw InputError(
        fmt::format("the log has no base.* columns, though {} has {}: the base counts as fixed, "
                    "and which links are sought is not said",
                    inputs.robot_yaml, unused),
        "log base.gyro and base.accel, or give --shapes, --free LINK or --whole-body");
  }
  if (robot.root == Root::fixed) {
    throw InputError("which links are sought is not said",
                     "give --shapes, --free LINK or --whole-body (a fixed base has no dynamics)");
  }
  return {0};
}

}  // namespace

void SoughtLinks::add_to(CLI::App& verb) {
  auto* of_shapes = verb.add_option("--shapes", shapes, "shapes.yaml");
  auto* named = verb.add_option("--free", free_links,
                                "links to identify, shapes from their collision bodies "
                                "(default: the floating base)");
  verb.add_flag("--whole-body", whole_body, "identify every link")
      ->excludes(of_shapes)
      ->excludes(named);
  named->excludes(of_shapes);
  verb.add_option("--expected-mass", expected_mass,
                  "kg, of all sought links together (default: as given)")
      ->check(mass_of_a_robot());
}

BodyModel sought_bodies(const SoughtLinks& sought, const RobotInputs& robot) {
  return sought.shapes.empty() ? default_shapes(robot.robot, links_of(sought, robot))
                               : read_shapes_yaml(sought.shapes, robot.robot);
}

double expected_mass(const SoughtLinks& sought, const RobotInputs& robot, const BodyModel& model) {
  if (sought.expected_mass > 0.0) return sought.expected_mass;
  const double mass = shapeid::expected_mass(robot.robot, robot.notes, model.free_links);
  if (!(mass > 0.0)) {
    throw InputError("the free links have no mass in the URDF",
                     "give --expected-mass, or expected_mass in robot.yaml");
  }
  return mass;
}

std::string unused_masses(const std::vector<int>& sought, const RobotInputs& robot) {
  std::vector<std::string> names;
  for (int i = 0; i < robot.robot.link_count(); ++i) {
    const std::string& name = robot.robot.links[static_cast<std::size_t>(i)].name;
    const bool is_sought = std::ranges::find(sought, i) != sought.end();
    if (!is_sought && robot.notes.expected_mass.contains(name)) names.push_back(name);
  }
  if (names.empty()) return {};
  return fmt::format(
      "{}: expected_mass counts for links that are sought; these are not, and have their given "
      "mass: {}",
      robot.robot_yaml, fmt::join(names, ", "));
}

void warn_of_unused_masses(const std::vector<int>& sought, RobotInputs& robot) {
  std::string warning = unused_masses(sought, robot);
  if (!warning.empty()) robot.warnings.push_back(std::move(warning));
}

}  // namespace shapeid::app
