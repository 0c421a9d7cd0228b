// Domain generators for rapidcheck: every value they make is valid, and so is every value that
// shrinking leads to, because what is drawn (and shrunk) are the free numbers behind a valid
// object.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Geometry>

#include "shapeid/models/inertia.hpp"
#include "shapeid/models/robot.hpp"
#include "shapeid/models/sample.hpp"

namespace shapeid::test {

/// A double in [lower, upper], evenly spread, shrinking toward zero if that lies inside and toward
/// `lower` otherwise.
[[nodiscard]] rc::Gen<double> real(double lower, double upper);

/// A positive double spread evenly over magnitudes, shrinking toward one.
[[nodiscard]] rc::Gen<double> magnitude(double lower, double upper);

[[nodiscard]] rc::Gen<Eigen::Vector3d> vector3(double bound);
[[nodiscard]] rc::Gen<Eigen::VectorXd> vector(Eigen::Index size, double bound);
[[nodiscard]] rc::Gen<Eigen::Vector3d> direction();
[[nodiscard]] rc::Gen<Eigen::Matrix3d> rotation();
/// A pose whose translation stays within `reach` (m) per axis.
[[nodiscard]] rc::Gen<Eigen::Isometry3d> pose(double reach);

/// A body that exists, from the Cholesky factor of its pseudo-inertia: asymmetric, rotated, off the
/// origin. Mass 0.05 to 20 kg, size a few centimetres to a few decimetres.
[[nodiscard]] rc::Gen<InertialParameters> body();

struct TreeShape {
  int fewest_links = 1, most_links = 20;
  Root root = Root::floating;
};

/// A branching tree of revolute, continuous and prismatic joints about arbitrary axes, with
/// arbitrary placements and bodies, and up to four contacts of all kinds. Shrinks to fewer links.
[[nodiscard]] rc::Gen<Robot> robot(const TreeShape& shape);

/// Nonzero positions, velocities, accelerations, torques; contacts touch at random. For a fixed
/// root the base stands upright and still.
[[nodiscard]] rc::Gen<Sample> sample(const Robot& robot);

}  // namespace shapeid::test
