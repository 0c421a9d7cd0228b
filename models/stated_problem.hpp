// A mass problem with all that its certificate may speak of: columns besides the masses, and the
// regions that the shapes fill.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"
#include "shapeid/models/shape.hpp"

namespace shapeid {

/// Unknowns beside the masses (effects such as friction), each with bounds of its own. A prior is
/// rows of the problem.
struct OtherColumns {
  Eigen::MatrixXd values;        ///< C, rows x columns
  Eigen::VectorXd lower, upper;  ///< infinite where there is none
};

/// Where a free link may have mass, however finely it is divided; or a shape that it is made of.
struct Region {
  Eigen::Index link = 0;  ///< place among the free links
  Shape shape;
};

/// minimise over m >= 0, sum m <= mass_bound (if that is positive), lower <= x <= upper:
///   || W^(1/2) (Y U m + C x - F) ||^2 + lambda sum_j m_j^2 / V_j
struct StatedProblem {
  MassProblem masses;
  OtherColumns others;  ///< may have no columns
  std::vector<Region> regions;
  /// What the columns of U are said to be, one each; or empty. Nothing is computed from them but
  /// whether that is so.
  std::vector<Region> shapes = {};
};

/// The shapes of a model, in their order, with their links' places among the free ones.
[[nodiscard]] std::vector<Region> regions_of(const BodyModel& model);

/// Empty if the mass problem is well-formed, the other columns have its rows and finite numbers,
/// lower bounds are not above upper ones, regions are well-formed shapes on free links, and so are
/// the shapes of all columns, if any is stated.
[[nodiscard]] Violation why_malformed(const StatedProblem& problem);

}  // namespace shapeid
