// What is known and what is sought about each link: given parameters, and shapes of unknown mass.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "shapeid/models/robot.hpp"
#include "shapeid/models/shape.hpp"

namespace shapeid {

/// A shape of unknown mass on a link.
struct SoughtShape {
  int link = 0;  ///< index in Robot::links
  Shape shape;
  std::string id;  ///< place in the list, then the way down the divisions: "3", "3.0", "3.0.1"
};

/// Phi of a link = known part + sum over its shapes of mass times unit parameters. The known part
/// is zero for a link identified from scratch, the given inertia for a known link, and the given
/// inertia of a link that carries an unknown load.
struct BodyModel {
  Eigen::VectorXd known;        ///< 10 per link of the robot, stacked
  std::vector<int> free_links;  ///< links with at least one shape, ascending
  std::vector<SoughtShape> shapes;
};

/// Empty if every shape's link is free.
[[nodiscard]] Violation why_on_known_links(const BodyModel& model);

/// Empty if every shape's link is free, every free link has a shape, and sizes agree.
[[nodiscard]] Violation why_malformed(const BodyModel& model, const Robot& robot);

/// U of equation (14): column j holds the unit parameters (13) of shape j in the ten rows of its
/// link. (10 per free link) x shapes.
[[nodiscard]] Eigen::MatrixXd shape_columns(const BodyModel& model);

/// Volumes of the shapes, m^3.
[[nodiscard]] Eigen::VectorXd shape_volumes(const BodyModel& model);

/// Parameters of all links, 10 per link of the robot: the known part, plus `Phi_free`, which the
/// shapes of the free links add (U m; 10 per free link).
[[nodiscard]] Eigen::VectorXd all_parameters(const BodyModel& model,
                                             const Eigen::VectorXd& Phi_free);

}  // namespace shapeid
