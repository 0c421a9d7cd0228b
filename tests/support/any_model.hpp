// Models with shapes of every kind on one or two links, and rows that some hidden body explains.
#pragma once

#include <rapidcheck.h>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::test {

struct ModelWithRows {
  BodyModel model;
  MassProblem problem;         ///< columns of the model's shapes, default lambda
  double expected_mass = 1.0;  ///< kg, that of the hidden bodies
};

/// One to six shapes on one link or two: cuboids, cylinders, ellipsoids, convex polyhedra (and
/// points, which do not divide). Six rows a sample for each link; noise from none to a tenth of the
/// forces.
[[nodiscard]] rc::Gen<ModelWithRows> model_with_rows();

/// One cuboid of the given sides (m) about `centre`, axes along the link's.
[[nodiscard]] BodyModel one_cuboid(const Eigen::Vector3d& centre, const Eigen::Vector3d& sides);

/// Gives the rows of `problem` the columns, volumes and default lambda of the model's shapes.
void use_shapes(MassProblem& problem, const BodyModel& model, double expected_mass);

}  // namespace shapeid::test
