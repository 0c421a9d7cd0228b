// The methods that are compared: each minimises the same data term over its own set of parameters.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shapeid/models/body_model.hpp"
#include "shapeid/tests/experiments/methods/data_term.hpp"

namespace shapeid::experiments {

/// One window's answer, before filter (17).
struct Answer {
  Vector10 Phi;        ///< kg, kg m, kg m^2
  double value = 0.0;  ///< f at Phi
  /// f is nowhere on the method's set below this, by weak duality, whoever found Phi.
  double floor = 0.0;
  bool converged = true;  ///< the solver's own word for it
  int pieces = 10;        ///< unknowns at the end
};

class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// The least data term over the method's set. Every window is solved on its own; the methods that
  /// iterate start at the same body.
  [[nodiscard]] virtual Vector10 solve(const DataTerm& f) = 0;
  /// The same with its proof of how good it is, which costs time that solve() does not.
  [[nodiscard]] virtual Answer answer(const DataTerm& f) = 0;
};

/// What the methods know besides a window.
struct Setting {
  BodyModel shapes;  ///< one free link, the base
  BodyModel points;
  double length = 0.1;         ///< m, size of the link
  double expected_mass = 5.0;  ///< kg
};

/// Mass >= 0, nothing else.
[[nodiscard]] std::unique_ptr<Method> make_linear();
/// The paper's condition (6), positive mass and positive definite body inertia, as published: a
/// smooth parametrisation and a general solver (Ceres).
enum class Effort {
  usual,  ///< Ceres' own tolerances and 50 iterations
  hard    ///< tolerances of 1e-14 and 200 iterations
};
[[nodiscard]] std::unique_ptr<Method> make_nonlinear(const Setting& setting, Effort effort);
/// The same set, by the barrier method.
[[nodiscard]] std::unique_ptr<Method> make_positive(const Setting& setting);
/// All conditions: pseudo-inertia positive semidefinite, by the barrier method.
[[nodiscard]] std::unique_ptr<Method> make_full(const Setting& setting);
/// The same set by log-Cholesky parameters and Ceres.
[[nodiscard]] std::unique_ptr<Method> make_log_cholesky(const Setting& setting, Effort effort);
/// Masses of the shapes (or points) of a model, lambda = 0.
[[nodiscard]] std::unique_ptr<Method> make_shapes(const BodyModel& model);
/// Shapes, divided until f is within `closed` of the floor of infinitely many divisions (relative
/// to the floor), or `most` times.
[[nodiscard]] std::unique_ptr<Method> make_divided(const Setting& setting, double closed, int most);

}  // namespace shapeid::experiments
