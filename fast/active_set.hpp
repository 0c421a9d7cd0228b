// Claim C3. The active-set method of the mass problem, on whatever holds the passive shapes.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/fast/passive_masses.hpp"
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
  too_many_steps,  ///< the bound on the steps of one call is reached, and shapes should still enter
  out_of_scale     ///< from Identifier: forces that no robot has
};

/// Minimises  || R U m - c ||^2 + lambda sum_j m_j^2 / V_j  over m >= 0: from given masses toward
/// the minimum of the passive shapes until one of them has no mass left, which is then held at
/// zero; and where nothing is in the way, the shape whose slope is steepest enters. The objective
/// falls with every step that changes the passive shapes. Derivation and the reasons for the
/// tolerances: docs/derivations/fast-masses.md.
///
/// After construction nothing allocates or throws; the steps of a run are bounded.
class ActiveSet {
 public:
  ActiveSet(const ActiveSet&) = delete;
  ActiveSet& operator=(const ActiveSet&) = delete;
  ~ActiveSet() = default;

  /// `columns` and `V` (m^3, an entry a shape) must outlive the object; `columns` has no shapes
  /// yet.
  ActiveSet(ShapeColumns& columns, const Eigen::VectorXd& V);

  /// The passive shapes are kept in `set`, made for this lambda.
  void use(PassiveSet& set, double lambda) noexcept;
  [[nodiscard]] bool uses(const PassiveSet& set) const noexcept { return set_ == &set; }

  /// From now on for this triangle [R c], which must stay as it is. False if a number of it is not
  /// finite: then nothing changes.
  [[nodiscard]] bool take(const Eigen::MatrixXd& R) noexcept;
  /// Back to the triangle before the last take().
  void take_back() noexcept;
  /// Whether the passive shapes are factorised, so that shapes may enter and leave one by one.
  [[nodiscard]] bool has_started() const noexcept { return started_; }
  /// Whether divide() keeps the factorisation.
  [[nodiscard]] bool divides_where_it_stands() const noexcept {
    return started_ && set_->can_divide();
  }
  [[nodiscard]] bool has_rows() const noexcept { return now_.has_rows(); }

  /// No passive shapes.
  void clear() noexcept;
  /// Shape `j`, if it is passive, gives `share` of its mass to shape `other`, which is not; where
  /// the next run starts. Returns what it gives, kg. Columns and volumes of both are known,
  /// and whether they make up the whole to a few roundings.
  double divide(int j, int other, double share, bool adds_up) noexcept;
  /// Shape `j` has this mass (kg, > 0) where the next run starts.
  void start_at(int j, double mass) noexcept;

  /// Shape `j`, passive, gives up its mass.
  void drop(int j) noexcept;
  /// Shape `j` becomes passive with this mass. If its column depends on the passive ones, mass
  /// moves among them with R U m as it is.
  void enter_with_mass(int j, double mass) noexcept;
  /// Likewise; but if its column depends on them, nothing changes, and the answer is false.
  [[nodiscard]] bool enter_beside(int j, double mass) noexcept;

  /// Whether more than a few of the passive shapes are without mass where these shapes alone are at
  /// their minimum: then masses to start from are of little use.
  [[nodiscard]] bool is_far_off() noexcept;
  /// To the minimum from the present masses; checked. An answer that does not pass is sought once
  /// more, shapes of a link entering one by one.
  Outcome run() noexcept;
  /// After run() with lambda = 0 on `set`: on to the minimum for this lambda, if that has the same
  /// passive shapes. False if that is not certain; then the masses stay.
  [[nodiscard]] bool damp(ColumnSet& set, double lambda) noexcept { return now_.damp(set, lambda); }
  /// From a guess at the minimum: whether it is the minimum once its masses are corrected. If not,
  /// nothing changes.
  [[nodiscard]] bool settles_at(Guess& guess) noexcept {
    const int pivots = guess.pivots();  // which are counted anew from its answer on
    if (!now_.settles_at(guess)) return false;
    iterations_ = pivots + 1;  // one to see that nothing is left to do
    started_ = false;
    return true;
  }
  /// Whether the answer stands if nothing has changed but that these shapes, without mass, have
  /// other columns.
  [[nodiscard]] bool stays_settled(const std::vector<int>& massless) noexcept {
    iterations_ = 1;
    return now_.stays_settled(massless);
  }
  /// The same after run() and perhaps damp(), by what these go by. False also if nothing is
  /// factorised.
  [[nodiscard]] bool none_enters(const std::vector<int>& shapes) noexcept;
  /// Whether every shape that is not passive would certainly raise the objective, and there are no
  /// more passive ones than independent columns.
  [[nodiscard]] bool is_at_a_vertex() noexcept { return now_.is_at_a_vertex(); }

  /// Remembers masses and what belongs to them, and goes back to it.
  void save() noexcept {
    iterations_ = 0;
    now_.save();
  }
  void restore() noexcept;

  [[nodiscard]] const std::vector<int>& passive() const noexcept { return now_.passive(); }
  [[nodiscard]] const std::vector<double>& masses() const noexcept { return now_.masses(); }
  [[nodiscard]] const Eigen::VectorXd& Phi() const noexcept { return now_.Phi(); }
  /// R^T (c - R Phi), 10 per link.
  [[nodiscard]] const Eigen::VectorXd& slopes() const noexcept { return now_.slopes(); }
  [[nodiscard]] const Objective& value() const noexcept { return now_.value(); }
  /// Steps since save().
  [[nodiscard]] int iterations() const noexcept { return iterations_ + now_.corrections(); }
  [[nodiscard]] const Eigen::MatrixXd& R() const noexcept { return now_.R(); }
  /// Of one link.
  [[nodiscard]] const LinkRows& link_rows() const noexcept { return now_.link_rows(); }
  /// Upper bounds of the lengths of the columns of R.
  [[nodiscard]] const Eigen::VectorXd& lengths() const noexcept { return now_.lengths(); }
  /// Tells the columns what prices are measured by, if they do not know yet.
  void scale_prices() noexcept { now_.scale_prices(); }

 private:
  [[nodiscard]] Outcome iterate() noexcept;
  void start() noexcept;
  void factorise() noexcept;
  void add(int j, double mass) noexcept;
  void leave(std::size_t place) noexcept;
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
  [[nodiscard]] bool passes_check() noexcept;

  PassiveMasses now_;  // first: its members are the most strictly aligned
  ShapeColumns* columns_;
  PassiveSet* set_ = nullptr;
  std::vector<double> tried_;        ///< masses to come back to
  std::vector<int> refused_;         ///< barred until the next step that is taken
  std::vector<ShapeMass> entering_;  ///< on their way into a fresh factorisation
  std::vector<int> joining_;         ///< the same without masses
  Eigen::VectorXd coefficients_;
  int iterations_ = 0;
  bool one_by_one_ = false;          ///< of each link, shapes enter
  bool started_ = false;             ///< set_ holds the passive shapes
  bool ended_with_refused_ = false;  ///< so that some were not asked at the end
};

}  // namespace shapeid::fast
