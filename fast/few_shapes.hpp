// A first answer where a link has few shapes: the base link of a robot that is watched online.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include "shapeid/fast/passive_set.hpp"
#include "shapeid/fast/shape_columns.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// The minimiser of the mass problem for up to a dozen shapes of one link, by principal pivots on
/// its normal equations: a pivot costs a dozen rows of a dozen numbers whether a shape enters or
/// leaves, and slopes and masses are always there to read. Forming H squares the condition, and the
/// pivots need not lead downhill: so this is a guess, to be corrected and checked by the one who
/// asks (ActiveSet::settles_at). Nothing allocates or throws.
class FewShapes final : public Guess {
 public:
  static constexpr int most_shapes = 12;
  /// The problem with its passive shapes exchanged.
  struct Exchanged {
    std::array<Dozen, most_shapes> H;  ///< of the passive shapes the inverse
    Dozen diagonal;                    ///< of H
    Dozen x;                           ///< masses of the passive shapes, slopes of the others
    Dozen side;                        ///< -1 for passive shapes, 1 for the others
    Dozen weight, other_weight;        ///< of x^2 on this side, signed as `side`; on the other side
    int pivots = 0;
  };

  /// No shapes.
  void clear() noexcept;
  /// Shape `j`, one of those that are there or the next, has this column.
  void put(int j, const ShapeColumns::Column& u) noexcept;
  /// Whether there are no more shapes than can be dealt with.
  [[nodiscard]] bool fits() const noexcept { return shapes_ <= most_shapes; }

  /// For the triangle of one link, from the shapes in `passive` on; only if they fit. False if no
  /// answer is found within four pivots a shape.
  [[nodiscard]] bool guess(const Eigen::VectorXd& V, double lambda, const LinkRows& rows,
                           const std::vector<int>& passive) noexcept;

  [[nodiscard]] bool is_passive(int j) const noexcept { return now_.side[place(j)] < 0.0; }
  /// Pivots of the last guess, those to its start left out.
  [[nodiscard]] int pivots() const noexcept override { return now_.pivots; }

  [[nodiscard]] AtPlaces answer() const noexcept override;
  [[nodiscard]] bool none_enters(const LinkRows& rows, const Dozen& slopes,
                                 double threshold) noexcept override;

  /// Entries in the order of the shapes.
  void solve_normal(Eigen::VectorXd& x) noexcept override;

 private:
  static std::size_t place(int j) noexcept { return static_cast<std::size_t>(j); }

  int shapes_ = 0;
  std::array<Dozen, 10> U_;
  Exchanged now_;
  Dozen sizes_;  ///< sum_i |u_ij| lengths_i
};

}  // namespace shapeid::fast
