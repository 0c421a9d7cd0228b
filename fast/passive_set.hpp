// What an active-set method asks of the shapes whose masses are free.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/fast/shape_columns.hpp"

namespace shapeid::fast {

/// The passive shapes of a mass problem, in order of entry, and the point where they alone minimise
/// the objective. Three kinds: one link at lambda = 0 (OneLink), several (ManyLinks), and lambda >
/// 0 (EvenDensity). None allocates or throws after construction.
class PassiveSet {
 public:
  PassiveSet() = default;
  PassiveSet(const PassiveSet&) = delete;
  PassiveSet& operator=(const PassiveSet&) = delete;
  virtual ~PassiveSet() = default;

  /// No passive shapes; the rows are those of the triangle R, 10 n + 1 square for n links,
  /// which must stay as it is until the next start.
  virtual void start(const Eigen::MatrixXd& R) noexcept = 0;

  /// Shape `j` becomes passive, behind the others. False if its column depends on those of the
  /// passive shapes: then nothing changes.
  [[nodiscard]] virtual bool enter(int j) noexcept = 0;
  /// These shapes become passive, as by enter() one after the other, until one is refused; returns
  /// how many did.
  [[nodiscard]] virtual std::size_t enter_first(std::span<const int> shapes) noexcept {
    std::size_t entered = 0;
    while (entered < shapes.size() && enter(shapes[entered])) ++entered;
    return entered;
  }
  /// After enter() said false: coefficients, one a passive shape, with which the passive columns
  /// add up to that of the refused shape.
  virtual void dependence(Eigen::VectorXd& coefficients) noexcept = 0;
  /// The shape at this place leaves; those behind it move forward.
  virtual void leave(int place) noexcept = 0;
  /// Whether any number of shapes of a link may be passive, so that those that are may be divided
  /// where they stand.
  [[nodiscard]] virtual bool can_divide() const noexcept { return false; }
  /// If so: the shape at this place has been divided, `other` is its second part and enters behind
  /// the others. Columns and volumes of both parts are known; `adds_up`: those of the parts make up
  /// those of the whole to a few roundings.
  virtual void divide(int /*place*/, int /*other*/, bool /*adds_up*/) noexcept {}
  /// False if rounding has made a column dependent that was not when it entered: shapes may still
  /// enter and leave, but masses mean nothing, and nothing but start() helps.
  [[nodiscard]] virtual bool sound() const noexcept { return true; }

  /// Masses of the passive shapes (kg, of any sign) at their minimum; the first entries count.
  [[nodiscard]] virtual const Eigen::VectorXd& target() noexcept = 0;
  /// A better target: one step of iterative refinement. `slopes` = R^T (c - R U m), 10 per link,
  /// come from the masses m of the present target alone. Only after target().
  virtual void refine(const Eigen::VectorXd& slopes) noexcept = 0;
  /// Whether slopes() are known without those of the residual, at no cost.
  [[nodiscard]] virtual bool keeps_slopes() const noexcept { return false; }
  /// At the target, for a shape that is not passive, -1/2 df/dm_j = u_j . slopes of its link: 10
  /// links. `of_residual`: R^T (c - R Phi) from the masses of the target; read only if the slopes
  /// are not kept.
  [[nodiscard]] virtual const Eigen::VectorXd& slopes(
      const Eigen::VectorXd& of_residual) noexcept = 0;
};

/// What corrects masses.
class NormalEquations {
 public:
  NormalEquations() = default;
  NormalEquations(const NormalEquations&) = delete;
  NormalEquations& operator=(const NormalEquations&) = delete;
  virtual ~NormalEquations() = default;

  /// Replaces x, an entry a passive shape, by the solution z of A^T A z = x with A = R U of the
  /// passive shapes, or what comes close to it.
  virtual void solve_normal(Eigen::VectorXd& x) noexcept = 0;
};

/// A guess at the answer for one link, by pivots: to be corrected and checked by the one who asks
/// (ActiveSet::settles_at). Solving the normal equations is for its passive shapes, in their order.
class Guess : public NormalEquations {
 public:
  /// How often settle() and its check may take turns; once is enough where single precision can
  /// tell and every shape that is passive has mass.
  static constexpr int most_rounds = 6;

  /// For these rows, which must stay as they are until the next start, with the shapes `passive`,
  /// as far as their columns do not depend on those before. False if there are too many: then only
  /// start() may follow.
  [[nodiscard]] virtual bool start(const LinkRows& rows, double lambda,
                                   const std::vector<int>& passive) noexcept = 0;
  /// Shape `j` gave its second part, of volume V2, to shape `other`, the last one; what remained
  /// has volume V1. To be called when columns and volumes of both are known. False if it cannot be
  /// followed: then only start() may follow.
  [[nodiscard]] virtual bool divide(int j, int other, double V1, double V2) noexcept = 0;
  /// Pivots until no mass is negative and no shape wants to enter, as far as can be seen. False if
  /// that does not come about.
  [[nodiscard]] virtual bool settle() noexcept = 0;
  /// The shapes at these places, a bit each, are to leave: as the check had them, their masses
  /// were not positive.
  virtual void let_go(unsigned places) noexcept = 0;
  /// Whether a shape wanted to enter when none_enters() was asked last, or some are to leave, so
  /// that settle() may go on.
  [[nodiscard]] virtual bool can_go_on() const noexcept = 0;

  /// The passive shapes and their masses: positive, but for rounding.
  [[nodiscard]] virtual AtPlaces answer() const noexcept = 0;
  /// Pivots that led to it.
  [[nodiscard]] virtual int pivots() const noexcept = 0;
  /// Whether no shape that is not passive has a price above `threshold` at these slopes.
  [[nodiscard]] virtual bool none_enters(const Dozen& slopes, double threshold) noexcept = 0;
  /// The masses of answer() were corrected, in its places, and the slopes with them.
  virtual void correct(const Dozen& masses, const Dozen& slopes) noexcept = 0;
};

/// A passive set whose columns are those of the shapes: for lambda = 0. Solving the normal
/// equations leaves the target as it is.
class ColumnSet : public PassiveSet, public NormalEquations {};

}  // namespace shapeid::fast
