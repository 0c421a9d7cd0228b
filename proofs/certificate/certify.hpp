// Anyone's answer to a stated problem: accepted or rejected, and how far from the optimum at most.
#pragma once

#include <Eigen/Core>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/problem_json.hpp"
#include "shapeid/proofs/certificate/consistency.hpp"
#include "shapeid/proofs/certificate/relaxations.hpp"

namespace shapeid::certificate {

/// When an answer is good enough. What is proved does not depend on it.
struct Tolerance {
  /// Of the objective above the optimum, relative to F^T W F, the objective of no mass at all.
  double gap = 1e-9;
  /// Of what an answer says beside its masses (parameters, objective), relative to the terms it is
  /// computed from; and, of parameters without masses, of their distance from the shapes' cone.
  double rounding = 1e-9;
};

/// A number is not below `lower`, nor above `upper`.
struct Between {
  double lower = 0.0;  ///< a sum of squares
  double upper = std::numeric_limits<double>::infinity();
};

/// Claim C18. The least data terms (lambda = 0) over larger sets than the shapes make. Each set
/// holds the next, and so the optima come in order (relaxations.hpp).
struct Ordered {
  Between masses;     ///< parameters with no negative mass
  Between bodies;     ///< bodies that can exist
  Between divisions;  ///< mass anywhere in the regions, however finely divided
  /// Whether the numbers alone put each strictly below the next, in exact arithmetic: masses below
  /// bodies, bodies below divisions, divisions below the answer's shapes.
  std::array<bool, 3> apart = {};
};

/// Of the columns of U, how many shapes are stated, how many columns are what their shape makes
/// (to Tolerance::rounding), and how many shapes are shown to lie in the regions (geometry.hpp).
struct Columns {
  Eigen::Index declared = 0, agree = 0, inside = 0;
};

/// Everything here is proved, in exact arithmetic, for the doubles of the problem; doubles of the
/// report are rounded outward. Infinite where nothing is proved.
struct Proof {
  std::string problem_digest, answer_digest;
  bool feasible = false;        ///< masses and columns keep every bound, the declared mass too
  double objective_above = 0;   ///< f of the answer's masses is not above
  double lower = 0;             ///< the optimum is not below
  double upper = 0;             ///< nor above
  double gap = 0;               ///< f of the answer minus the optimum is not above
  bool optimum_known = false;   ///< solved exactly; lower and upper are its two neighbours
  bool free_set_right = false;  ///< with the answer's own set of shapes with mass
  double mass_bound = 0;        ///< kg: M
  bool mass_bound_declared = false;
  /// kg: no mass is farther from an optimum's; the only one, if lambda > 0. At lambda = 0 zero or
  /// infinite: whether the answer is one of perhaps many.
  double mass_distance = 0;
  /// The same of kg, kg m, kg m^2.
  Eigen::Vector3d parameter_distance = Eigen::Vector3d::Zero();
  /// The parameters claimed are exactly U m, of the masses that are judged, and m >= 0.
  bool made_of_shapes = false;
  Eigen::VectorXd plane;  ///< if not: a separating plane, rounded, 10 per free link; else empty
  std::vector<Existence> bodies;  ///< of the free links, U m exactly
  std::optional<double> floor;    ///< of infinitely many divisions; empty: none above zero
  Ordered relaxations;
  Columns columns;
};

struct Certified {
  Proof proof;
  std::vector<std::string> reasons;  ///< why the answer is rejected; empty: accepted
};

/// Empty if the answer has the sizes of the problem and finite numbers: then certify() can be
/// called.
[[nodiscard]] Violation why_unfit(const StatedProblem& problem, const Answer& answer);

/// Without evidence of a relaxation next to nothing is said of it.
[[nodiscard]] Certified certify(const StatedProblem& problem, const Answer& answer,
                                const Tolerance& tolerance = {}, const Evidence& evidence = {});

}  // namespace shapeid::certificate
