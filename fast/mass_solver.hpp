// Claim C3. The mass problem (15) on a compressed window, solved at the pace of the robot.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <vector>

#include "shapeid/fast/even_density.hpp"
#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::fast {

/// How a call ended. Anything but solved means that it declined: masses and everything else are as
/// before the call, and the reference may be asked instead.
enum class Outcome {
  solved,
  not_finite,       ///< a number of the rows is not finite
  ill_conditioned,  ///< the answer does not pass its own check: its gradient is not small enough
  too_many_steps  ///< the bound on the steps of one call is reached, and shapes should still enter
};

/// Minimises  || R U m - c ||^2 + lambda sum_j m_j^2 / V_j  over m >= 0, with [R c] the triangle of
/// a window: the same minimiser as `reference::solve_masses` (lambda > 0), or the same minimum
/// (lambda = 0). A primal active-set method: from the last masses, or from none, toward the minimum
/// of the passive shapes until one of them has no mass left, which is then held at zero; and where
/// nothing is in the way, the shape whose slope is steepest enters. The objective falls with every
/// step that changes the passive shapes.
///
/// After construction nothing allocates or throws; the steps of a call are bounded.
class MassSolver {
 public:
  using Column = ShapeColumns::Column;

  /// Room for `most_shapes` shapes on `links` free links.
  MassSolver(int links, int most_shapes);

  /// No shapes.
  void clear() noexcept;
  /// Adds a shape without mass: unit parameters and volume (m^3, > 0). `link`: place among the free
  /// links. False if there is no room.
  [[nodiscard]] bool append(int link, const Column& u, double V) noexcept;
  /// lambda >= 0.
  void set_lambda(double lambda) noexcept;

  /// Solves for the triangle [R c], (10 links + 1) x (10 links + 1) as Triangle::R() has it,
  /// starting from the present masses. The triangle must stay as it is while divide() is used.
  Outcome solve(const Eigen::MatrixXd& R) noexcept;
  /// Back to no masses: the next solve() starts cold.
  void forget_masses() noexcept;
  /// Gives shape `j` this mass (kg, > 0), for the next solve() to start at.
  void start_at(int j, double mass) noexcept;

  /// Divides shape `j` at equal density: `first` (volume V1) takes its place, `second` (V2) becomes
  /// the last shape. The objective stays as it is, and so does Phi as far as the rows feel it.
  /// False if there is no room.
  [[nodiscard]] bool divide(int j, const Column& first, double V1, const Column& second,
                            double V2) noexcept;
  /// Empty if R U m and the density term still are those of the last answer, to rounding: what
  /// divide() promises. Only after solve().
  [[nodiscard]] Violation why_changed() const;
  /// Solves again, for the triangle of the last solve(), after divide().
  Outcome solve_again() noexcept;

  [[nodiscard]] int shapes() const noexcept { return columns_.size(); }
  [[nodiscard]] int links() const noexcept { return columns_.links(); }
  /// kg, one a shape; zero or positive.
  [[nodiscard]] auto m() const noexcept { return m_.head(shapes()); }
  /// m^3, one a shape.
  [[nodiscard]] auto V() const noexcept { return V_.head(shapes()); }
  /// U m: 10 links.
  [[nodiscard]] const Eigen::VectorXd& Phi() const noexcept { return Phi_; }
  /// f(m), the constant that no parameter reaches included.
  [[nodiscard]] const Objective& value() const noexcept { return value_; }
  /// Shapes that are not held at zero, in no order.
  [[nodiscard]] const std::vector<int>& passive() const noexcept { return passive_; }
  /// Steps of the last call, each one small system.
  [[nodiscard]] int iterations() const noexcept { return iterations_; }

  /// An upper bound of f(m) minus the minimum, if the masses of the minimum add up to no more than
  /// `mass_bound` (kg). Rounding aside; the certificate proves it.
  [[nodiscard]] double gap(double mass_bound) const noexcept;

 private:
  struct ShapeMass {
    int place;
    double mass;
  };

  Outcome iterate() noexcept;
  void start() noexcept;
  void add(int j, double mass) noexcept;
  void enter_with_mass(int j, double mass) noexcept;
  void leave(int place) noexcept;
  [[nodiscard]] bool step_is_blocked() noexcept;
  [[nodiscard]] bool may_cut_off(const Eigen::VectorXd& target) noexcept;
  void leave_without_mass() noexcept;
  [[nodiscard]] const std::vector<int>& entering_shapes() noexcept;
  [[nodiscard]] bool some_enter() noexcept;
  [[nodiscard]] bool refine() noexcept;
  [[nodiscard]] bool some_are_refused(std::size_t first) noexcept;
  void refuse_without_mass(std::size_t first) noexcept;
  void refuse(int j) noexcept;
  void admit_refused() noexcept;
  void evaluate() noexcept;
  [[nodiscard]] double largest_slope() const noexcept;
  [[nodiscard]] bool passes_check() noexcept;
  void save() noexcept;
  void restore() noexcept;

  ShapeColumns columns_;
  Eigen::VectorXd m_, V_;
  double lambda_ = 0.0;
  std::unique_ptr<PassiveSet> undamped_;  ///< for lambda = 0
  EvenDensity damped_;                    ///< for lambda > 0
  PassiveSet* set_;                       ///< the one in use
  bool started_ = false;                  ///< set_ holds the passive shapes
  const Eigen::MatrixXd* R_ = nullptr;
  Eigen::VectorXd lengths_;
  double length_ = 0.0;  ///< of c
  std::vector<int> passive_;
  std::vector<double> masses_;       ///< of the passive shapes
  std::vector<double> tried_;        ///< masses to come back to
  std::vector<int> refused_;         ///< barred until the next step that is taken
  std::vector<ShapeMass> saved_;     ///< as they were before the call
  std::vector<ShapeMass> entering_;  ///< on their way into a fresh factorisation
  Eigen::VectorXd coefficients_, Phi_, r_, slopes_, sizes_;
  Objective value_;
  Eigen::VectorXd other_lengths_;             ///< of the triangle that is not in use
  Eigen::VectorXd saved_Phi_, saved_slopes_;  ///< as they were before the call
  Objective saved_value_;
  int iterations_ = 0;
};

}  // namespace shapeid::fast
