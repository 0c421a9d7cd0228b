// A mass problem in the forms that different solvers start from.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::bench {

/// How a problem's columns came out of those of the problem before it: the shape at `place` was
/// cut, its first part has its place, the second is the last column.
struct Cut {
  Eigen::Index place;
  double first_share;  ///< of the volume
};

/// A mass problem whose rows are compressed: Y is the triangle R (10 n square, n links), F the
/// right-hand side's part that parameters can reach, W is one. Columns of U stand link by link.
struct DenseProblem {
  MassProblem triangle;
  Eigen::MatrixXd R;                ///< [R c] over a row of zeros: what fast::Triangle would hold
  std::vector<Eigen::Index> first;  ///< links + 1: where each link's columns start in U
  bool follows = false;             ///< the next of its sequence: a warm start makes sense
  std::optional<Cut> cut;           ///< if it follows by a division
};

/// What the peers ask for. minimise || A m - b ||^2, or 1/2 m^T H m + g^T m, over m >= 0.
struct Prepared {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  Eigen::MatrixXd H;  ///< A^T A
  Eigen::VectorXd g;  ///< -A^T b
};

enum class Form { triangle, rows, normal };

/// Computes what `form` needs, block by block, into memory that is kept from call to call.
void prepare(const DenseProblem& problem, Form form, Prepared& out);

enum class Density {
  none,   ///< lambda = 0, the published problem
  design  ///< lambda = default_lambda()
};

/// Where a solver may start: the last answer, with the cut shape's mass divided by volume.
void carry_over(const DenseProblem& to, const Eigen::VectorXd& last, Eigen::VectorXd& start);

/// Compresses a problem of any number of rows. What no parameter reaches is left out: it is the
/// same for every m. Rows are scaled to || F || = 1, so that the absolute tolerances which some
/// solvers have mean the same for every problem. The mass that lambda is made for is the volume's
/// at the density of water.
[[nodiscard]] DenseProblem compressed(const MassProblem& problem, const BodyModel& model,
                                      Density density);

}  // namespace shapeid::bench
