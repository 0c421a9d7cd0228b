// A first answer where a link has few shapes, as they are divided too: the base link of a robot
// that is watched online.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include "shapeid/fast/few_table.hpp"
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
  static constexpr int most_shapes = few::most_shapes;

  /// `V` (m^3, an entry a shape) must outlive the object.
  explicit FewShapes(const Eigen::VectorXd& V) : V_(&V) {}

  /// No shapes.
  void clear() noexcept;
  /// Shape `j`, one of those that are there or the next, has this column.
  void put(int j, const ShapeColumns::Column& u) noexcept;
  /// Whether there are no more shapes than can be dealt with.
  [[nodiscard]] bool fits() const noexcept { return shapes_ <= most_shapes; }

  [[nodiscard]] bool start(const LinkRows& rows, double lambda,
                           const std::vector<int>& passive) noexcept override;
  [[nodiscard]] bool divide(int j, int other, double V1, double V2) noexcept override;
  /// Four pivots a shape at most.
  [[nodiscard]] bool settle() noexcept override;
  void let_go(unsigned places) noexcept override { leaving_ = places; }
  /// A shape that the check sees to enter is beyond these pivots.
  [[nodiscard]] bool can_go_on() const noexcept override { return leaving_ != 0; }

  [[nodiscard]] AtPlaces answer() const noexcept override;
  [[nodiscard]] int pivots() const noexcept override { return now_.pivots; }
  [[nodiscard]] bool none_enters(const Dozen& slopes, double threshold) noexcept override;
  void correct(const Dozen& masses, const Dozen& slopes) noexcept override;
  /// Entries in the order of the shapes.
  void solve_normal(Eigen::VectorXd& x) noexcept override;

 private:
  [[nodiscard]] bool is_passive(int j) const noexcept { return (now_.passive >> j & 1U) != 0; }
  static std::size_t place(int j) noexcept { return static_cast<std::size_t>(j); }

  std::array<Dozen, 10> U_;  // first: these are the most strictly aligned
  few::Table now_;
  Dozen sizes_;  ///< sum_i |u_ij| lengths_i
  const Eigen::VectorXd* V_;
  const LinkRows* rows_ = nullptr;
  double lambda_ = 0.0;
  double smallest_ = 0.0;  ///< gain that is followed
  int shapes_ = 0;
  unsigned leaving_ = 0;  ///< next; a bit a shape
};

}  // namespace shapeid::fast
