// The masses of one link by principal pivots in its ten parameters, however many shapes it has.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "shapeid/fast/link_rows.hpp"
#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/fast/tableau.hpp"
#include "shapeid/fast/tableau_pivots.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// A guess at the masses of one link, for lambda >= 0. Kept are, for the passive shapes P with
/// A = R U_P,
///
///     K = (A^T A + lambda V_P^-1)^-1,      C^T = K A^T R,      m = K A^T c,
///     M = R^T (R - A C^T),                 g = R^T (c - A m):
///
/// a shape that enters or leaves changes each by one product of two vectors, and every other shape
/// is priced with the ten numbers of g. A division changes the basis. Forming R^T R squares the
/// condition and pivots need not lead downhill, so this is a guess, to be corrected and checked.
/// Nothing allocates or throws after construction.
class LinkTable final : public Guess {
 public:
  /// More passive shapes are not dealt with.
  static constexpr std::size_t most_passive = tableau::most_passive;

  /// `columns`, of one link, and `V` (m^3, an entry a shape) must outlive the object. Bars the
  /// passive shapes, and those alone.
  LinkTable(ShapeColumns& columns, const Eigen::VectorXd& V);

  /// `columns` know the scale of these rows.
  [[nodiscard]] bool start(const LinkRows& rows, double lambda,
                           const std::vector<int>& passive) noexcept override;
  [[nodiscard]] bool divide(int j, int other, double V1, double V2) noexcept override;
  [[nodiscard]] bool settle() noexcept override;
  void let_go(unsigned places) noexcept override { leaving_ = places; }
  [[nodiscard]] bool can_go_on() const noexcept override { return wanting_ >= 0 || leaving_ != 0; }

  [[nodiscard]] AtPlaces answer() const noexcept override;
  [[nodiscard]] int pivots() const noexcept override { return pivots_; }
  [[nodiscard]] bool none_enters(const Dozen& slopes, double threshold) noexcept override;
  void correct(const Dozen& masses, const Dozen& slopes) noexcept override;
  void solve_normal(Eigen::VectorXd& x) noexcept override;

 private:
  /// False if it depends on those that are passive, or there is no place for it.
  [[nodiscard]] bool enter_shape(int j) noexcept;
  [[nodiscard]] double slope_of(int j, const Dozen& slopes) const noexcept;
  [[nodiscard]] int steepest_doubtful(const Dozen& slopes, double threshold) const noexcept;
  [[nodiscard]] bool is_used(std::size_t place) const noexcept {
    return (now_.used >> place & 1U) != 0;
  }

  tableau::Tableau now_;  // first: its members are the most strictly aligned
  tableau::Problem problem_;
  ShapeColumns* columns_;
  const Eigen::VectorXd* V_;
  const LinkRows* rows_ = nullptr;
  int pivots_ = 0;
  int wanting_ = -1;      ///< a shape to enter next
  unsigned leaving_ = 0;  ///< places to leave next, a bit each
  /// Where settle() ended; all others certainly did not want to enter.
  tableau::Doubtful doubtful_;
  bool knows_doubtful_ = false;
  Eigen::VectorXd slopes_;
};

}  // namespace shapeid::fast
