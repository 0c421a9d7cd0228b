#include "shapeid/app/load_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "shapeid/app/no_mass.hpp"
#include "shapeid/models/error.hpp"

namespace shapeid::app {
namespace {

InertialParameters found_load(const Result& result) {
  return {result.found.run.solution.Phi.head<10>()};
}

const std::string& carrier(const Result& result, const Robot& robot) {
  const int link = result.found.run.model.free_links.front();
  return robot.links[static_cast<std::size_t>(link)].name;
}

/// Errors beyond which a number is no chance, few blocks allowed for.
double certain(const Result& result) { return 3.0 * result.found.data.wider; }

/// The area that was searched: the load's one shape, before the first division.
const Eigen::Affine3d& area(const Result& result) {
  return std::get<Cuboid>(result.sought.shapes.front().shape).frame;
}

/// How far a place in the link's frame is outside the area, m.
double outside(const Result& result, const Eigen::Vector3d& place) {
  const Eigen::Array3d sides = area(result).linear().colwise().norm().transpose().array();
  const Eigen::Array3d beyond = (area(result).inverse() * place).array().abs() - 0.5;
  return (beyond.max(0.0) * sides).matrix().norm();
}

std::string below_zero_note(const Result& result, const Robot& robot) {
  return fmt::format(
      "by themselves the data ask for a load of {:.3g} kg (s.e. {:.2g}) on {}, less than none: the "
      "given inertias are too large, or torques, accelerometer or contacts are not what they are "
      "taken for",
      result.found.data.value[0], result.found.data.standard_error[0], carrier(result, robot));
}

/// Filters, too, move a place: by less than a tenth of an area that is worth searching.
std::string outside_note(const Result& result, const Robot& robot) {
  constexpr double far = 0.1;
  const reference::Determination& data = result.found.data;
  const double mass = data.value[0];
  const Eigen::Vector3d centre = data.value.segment<3>(1) / mass;
  const Eigen::Vector3d error =
      (data.standard_error.segment<3>(1) + centre.cwiseAbs() * data.standard_error[0]) / mass;
  const double largest = area(result).linear().colwise().norm().maxCoeff();
  const double away = outside(result, centre);
  if (!(away > certain(result) * error.norm() && away > far * largest)) return {};
  return fmt::format(
      "by themselves the data put the load's centre at ({:.4f}, {:.4f}, {:.4f}) m of {}'s frame, "
      "{:.2g} m outside the area: it is in another place, or on another link",
      centre.x(), centre.y(), centre.z(), carrier(result, robot), away);
}

/// Where robot.yaml says how heavy a load may be; empty if this one is.
std::string unexpected_note(const Result& result, const RobotInputs& robot) {
  const auto range = robot.notes.expected_mass.find("load");
  if (range == robot.notes.expected_mass.end()) return {};
  const double mass = found_load(result).mass();
  const double errors = certain(result) * result.found.standard_error[0];
  const auto [lower, upper] = range->second;
  if (!(mass < lower - errors || mass > upper + errors)) return {};
  return fmt::format("{} expects a load of {:g} to {:g} kg", robot.robot_yaml, lower, upper);
}

void add_if_any(std::string note, std::vector<std::string>& notes) {
  if (!note.empty()) notes.push_back(std::move(note));
}

}  // namespace

std::vector<std::string> load_notes(const Result& result, const RobotInputs& robot,
                                    double expected_mass) {
  const reference::Determination& data = result.found.data;
  const double mass = found_load(result).mass(), given = robot.robot.mass();
  // Differentiation alone makes as much: of what is expected, and of the robot (13 g of 13 kg).
  const double little = std::max(0.01 * expected_mass, 0.002 * given);
  const bool is_certain = !data.agrees(0, 0.0);
  std::vector<std::string> notes;
  if (is_certain && data.value[0] < -little) {
    notes.push_back(below_zero_note(result, robot.robot));
  }
  if (is_certain && data.value[0] > little) add_if_any(outside_note(result, robot.robot), notes);
  if (mass > 0.0 && mass <= certain(result) * result.found.standard_error[0]) {
    notes.emplace_back("a load as small as this is not told from none, and its place says nothing");
  }
  if (given > 0.0 && mass > given) {
    notes.push_back(fmt::format(
        "the load weighs {:.2g} times as much as the robot itself: is the torque in N m?",
        mass / given));
  }
  add_if_any(unexpected_note(result, robot), notes);
  return notes;
}

void check_some_weight(const Result& result, const Robot& robot) {
  const reference::Determination& data = result.found.data;
  constexpr double nothing = 0.05;  // of what it should weigh, as where its feet are no contacts
  const double given = robot.mass(), left = given + data.value[0];
  if (!(left + certain(result) * data.standard_error[0] < nothing * given)) return;
  throw Refusal("no-mass", fmt::format("the log asks for a load of {:.3g} kg on a robot of {:.3g} "
                                       "kg, of which nothing would be left: {}",
                                       data.value[0], given, causes_of_no_mass));
}

std::string filter_note(const Result& result, const LoadElsewhere& other) {
  constexpr double far = 3.0;  // standard errors of a difference
  const double here = found_load(result).mass(), error = result.found.standard_error[0];
  if (!(std::abs(here - other.mass) > far * std::hypot(error, other.error))) return {};
  return fmt::format(
      "behind another filter (--cutoff {:g} --row-cutoff {:g}) the load is {:.4g} kg (s.e. "
      "{:.2g}): "
      "what filters do to the motion is more than standard errors contain",
      other.cutoff, other.row_cutoff, other.mass, other.error);
}

nlohmann::json load_json(const Result& result, const Robot& robot,
                         const std::optional<LoadElsewhere>& other) {
  const InertialParameters load = found_load(result);
  const Eigen::Vector3d c = load.centre_of_mass();
  const Eigen::Matrix3d I = load.tensor_about_centre();
  nlohmann::json document = {{"link", carrier(result, robot)}, {"mass", load.mass()}};
  if (load.mass() > 0.0) {
    document["centre"] = {c.x(), c.y(), c.z()};
    document["inertia_about_centre"] = {I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2)};
  }
  if (other) {
    document["other_filter"] = {{"cutoff", other->cutoff},
                                {"row_cutoff", other->row_cutoff},
                                {"mass", other->mass},
                                {"standard_error", other->error}};
  }
  return document;
}

std::string load_text(const Result& result, const Robot& robot) {
  const InertialParameters load = found_load(result);
  if (!(load.mass() > 0.0)) return fmt::format("\nno load on {}\n", carrier(result, robot));
  const Eigen::Vector3d c = load.centre_of_mass();
  const double mass_error = result.found.standard_error[0];
  return fmt::format(
      "\nload on {}: {:.4g} kg (s.e. {:.2g}) at ({:.4f}, {:.4f}, {:.4f}) m of {}'s frame\n",
      carrier(result, robot), load.mass(), mass_error, c.x(), c.y(), c.z(), carrier(result, robot));
}

}  // namespace shapeid::app
