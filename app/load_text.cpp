#include "shapeid/app/load_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace shapeid::app {
namespace {

InertialParameters found_load(const Result& result) {
  return {result.found.run.solution.Phi.head<10>()};
}

const std::string& carrier(const Result& result, const Robot& robot) {
  const int link = result.found.run.model.free_links.front();
  return robot.links[static_cast<std::size_t>(link)].name;
}

}  // namespace

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
