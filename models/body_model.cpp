#include "shapeid/models/body_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace shapeid {
namespace {

/// Place of a link among the free links, or -1.
Eigen::Index place_of(const BodyModel& model, int link) {
  const auto found = std::find(model.free_links.begin(), model.free_links.end(), link);
  return found == model.free_links.end() ? -1 : found - model.free_links.begin();
}

}  // namespace

Violation why_on_known_links(const BodyModel& model) {
  for (const SoughtShape& s : model.shapes) {
    if (place_of(model, s.link) < 0) return fmt::format("shape {} is on no free link", s.id);
  }
  return std::nullopt;
}

Violation why_malformed(const BodyModel& model, const Robot& robot) {
  if (model.known.size() != Eigen::Index{10} * robot.link_count()) {
    return fmt::format("known parameters have {} entries, the robot needs {}", model.known.size(),
                       10 * robot.link_count());
  }
  if (!std::is_sorted(model.free_links.begin(), model.free_links.end())) {
    return "free links are not in ascending order";
  }
  for (const int link : model.free_links) {
    if (link < 0 || link >= robot.link_count()) return fmt::format("free link {} is none", link);
    const bool has_shape = std::any_of(model.shapes.begin(), model.shapes.end(),
                                       [&](const SoughtShape& s) { return s.link == link; });
    if (!has_shape) return fmt::format("free link {} has no shape", link);
  }
  return why_on_known_links(model);
}

Eigen::MatrixXd shape_columns(const BodyModel& model) {
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(10 * static_cast<Eigen::Index>(model.free_links.size()),
                                            static_cast<Eigen::Index>(model.shapes.size()));
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    const SoughtShape& s = model.shapes[static_cast<std::size_t>(j)];
    U.block<10, 1>(10 * place_of(model, s.link), j) = unit_parameters(s.shape).values;
  }
  return U;
}

Eigen::VectorXd shape_volumes(const BodyModel& model) {
  Eigen::VectorXd V(static_cast<Eigen::Index>(model.shapes.size()));
  for (Eigen::Index j = 0; j < V.size(); ++j) {
    V[j] = volume(model.shapes[static_cast<std::size_t>(j)].shape);
  }
  return V;
}

Eigen::VectorXd all_parameters(const BodyModel& model, const Eigen::VectorXd& Phi_free) {
  Eigen::VectorXd Phi = model.known;
  for (std::size_t i = 0; i < model.free_links.size(); ++i) {
    Phi.segment<10>(Eigen::Index{10} * model.free_links[i]) +=
        Phi_free.segment<10>(10 * static_cast<Eigen::Index>(i));
  }
  return Phi;
}

}  // namespace shapeid
