// Claim C3. The mass problem (15) on a compressed window, solved at the pace of the robot.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <vector>

#include "shapeid/fast/active_set.hpp"
#include "shapeid/fast/even_density.hpp"
#include "shapeid/fast/few_shapes.hpp"
#include "shapeid/fast/link_table.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/models/mass_problem.hpp"

namespace shapeid::fast {

/// Minimises  || R U m - c ||^2 + lambda sum_j m_j^2 / V_j  over m >= 0, with [R c] the triangle of
/// a window: the same minimiser as `reference::solve_masses` (lambda > 0), or the same minimum
/// (lambda = 0). By an active-set method on one of two sets of passive shapes: columns that are
/// independent, or, where lambda decides among more of them, the even density. One link is tried by
/// pivots first.
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
  /// links. False if there is no room. The largest entry of u lies between 1e-30 and 1e30 (or all
  /// are zero), for shapes are priced in single precision; that of a body is its mass, one.
  [[nodiscard]] bool append(int link, const Column& u, double V) noexcept;
  /// lambda >= 0.
  void set_lambda(double lambda) noexcept;

  /// Solves for the triangle [R c], 10 n + 1 square for n links, as Triangle::R() has it,
  /// starting from the present masses, or without where these are of little use. R is not copied:
  /// it must live, and stay as it is, as long as divide(), solve_again() or why_changed() are used
  /// after it. If the call declines, these speak of the triangle that was solved last, which
  /// therefore must still be there.
  Outcome solve(const Eigen::MatrixXd& R) noexcept;
  /// Back to no masses: the next solve() starts cold.
  void forget_masses() noexcept;
  /// Gives shape `j` this mass (kg, > 0), for the next solve() to start at.
  void start_at(int j, double mass) noexcept;

  /// Divides shape `j` at equal density: `first` (volume V1) takes its place, `second` (V2) becomes
  /// the last shape. The objective stays as it is, and so does Phi as far as the rows feel it, and
  /// both as far as the parts make up the shape.
  /// False if there is no room.
  [[nodiscard]] bool divide(int j, const Column& first, double V1, const Column& second,
                            double V2) noexcept;
  /// Empty if R U m and the density term still are those of the last answer, to rounding: what
  /// divide() promises. Also empty if there is no last answer, or masses were set since.
  [[nodiscard]] Violation why_changed() const;
  /// Solves again, for the triangle that was solved last, after divide(). Some triangle must have
  /// been: after none but declined ones it is a defect of the caller.
  Outcome solve_again() noexcept;

  [[nodiscard]] int shapes() const noexcept { return columns_.size(); }
  [[nodiscard]] int links() const noexcept { return columns_.links(); }
  /// kg, one a shape; zero or positive.
  [[nodiscard]] auto m() const noexcept { return m_.head(shapes()); }
  /// m^3, one a shape.
  [[nodiscard]] auto V() const noexcept { return V_.head(shapes()); }
  /// U m: 10 per link.
  [[nodiscard]] const Eigen::VectorXd& Phi() const noexcept { return method_.Phi(); }
  /// f(m), the constant that no parameter reaches included.
  [[nodiscard]] const Objective& value() const noexcept { return method_.value(); }
  /// Shapes that are not held at zero, in no order.
  [[nodiscard]] const std::vector<int>& passive() const noexcept { return method_.passive(); }
  /// Steps of the last call, each one small system.
  [[nodiscard]] int iterations() const noexcept { return method_.iterations(); }

  /// An upper bound of f(m) minus the minimum, if the masses of the minimum add up to no more than
  /// `mass_bound` (kg). Rounding aside; the certificate proves it.
  [[nodiscard]] double gap(double mass_bound) const noexcept;

 private:
  [[nodiscard]] bool add(int link, const Column& u, double V) noexcept;
  [[nodiscard]] bool start_guess(const std::vector<int>& start) noexcept;
  [[nodiscard]] bool keep_guess_to_divide() noexcept;
  [[nodiscard]] bool try_guess() noexcept;
  [[nodiscard]] bool guess_again() noexcept;
  [[nodiscard]] const std::vector<int>& worth_starting_from() noexcept;
  void see_what_stayed() noexcept;
  void start_watching() noexcept;
  void watch(int j, int other) noexcept;
  [[nodiscard]] bool settles_at_guess() noexcept;
  [[nodiscard]] Outcome solve_by_method() noexcept;
  void keep_failed_guess() noexcept;
  void start_at_failed_guess() noexcept;
  void forget_useless_masses() noexcept;
  [[nodiscard]] Outcome solve_damped() noexcept;
  [[nodiscard]] Outcome solve_damped_anew() noexcept;
  [[nodiscard]] Outcome spread_evenly() noexcept;
  void give(int j, double mass) noexcept;
  void take_masses_out() noexcept;
  void put_masses_in() noexcept;

  ShapeColumns columns_;
  Eigen::VectorXd m_, V_;
  std::unique_ptr<ColumnSet> vertex_;  ///< passive shapes with independent columns
  double lambda_ = 0.0;
  Guess* guess_ = nullptr;   ///< that of the passive shapes, of one link, if there is one
  std::vector<int> before_;  ///< passive shapes of the last triangle
  std::vector<int> heavy_;   ///< of these
  std::vector<ShapeMass> failed_guess_;  ///< at the present triangle; empty if none has failed
  std::vector<int> massless_;            ///< parts of shapes without mass, since the last answer
  bool only_massless_ = false;           ///< no others were divided
  bool most_stay_ = true;    ///< passive from one triangle to the next; clear() keeps it
  bool is_new_ = false;      ///< the triangle
  bool has_answer_ = false;  ///< masses are those of the last answer, or were divided since
  bool at_vertex_ = true;    ///< where the next call may start, for lambda > 0
  FewShapes few_;            ///< a guess where a link has few shapes
  LinkTable table_;          ///< and where it has more
  ActiveSet method_;
  EvenDensity even_;  ///< passive shapes, any number of them, for lambda > 0
};

}  // namespace shapeid::fast
