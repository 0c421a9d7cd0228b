// The rows that even density among the passive shapes of one link is made of.
#pragma once

#include <Eigen/Core>

#include <array>

#include "shapeid/fast/ten_by_ten.hpp"
#include "shapeid/fast/wide.hpp"

namespace shapeid::fast {

/// The rows sqrt(V_j) u_j^T of the passive shapes of a link, as far as it takes to spread masses
/// evenly among them: never stored, but for their triangle X, updated as shapes enter and leave,
/// and the rows E of X that remain once its rank is revealed. Nothing allocates or throws.
class LinkDensity {
 public:
  using Ten = Eigen::Matrix<double, 10, 1>;

  /// No shapes.
  void clear() noexcept;
  /// A shape enters; it is left out of an outdated triangle.
  void enter(const Ten& row) noexcept;
  /// A shape leaves, and the triangle may be outdated then.
  void leave(const Ten& row) noexcept;
  /// Whether X must be made anew from its rows: by begin_anew(), and again() for every shape.
  [[nodiscard]] bool outdated() const noexcept { return outdated_; }
  void outdate() noexcept { outdated_ = true; }
  void begin_anew() noexcept;
  void again(const Ten& row) noexcept;

  /// Makes E of X, unless that is done; whether it was not. With Q^T X = E, its first rank() rows
  /// in the order of their pivots and zeros below them: Phi = E^T y of the link, and lambda || y
  /// ||^2 is its density term.
  bool reveal() noexcept;
  [[nodiscard]] const TenRows& E() const noexcept { return E_; }
  [[nodiscard]] int rank() const noexcept { return rank_; }
  /// Of these, directions in which the shapes spread well.
  [[nodiscard]] int certain() const noexcept { return certain_; }

  /// The w that satisfies the first `rank` rows of E w = y, its other entries those of `rest`.
  [[nodiscard]] Ten weights(int rank, const Ten& y, const Ten& rest) const noexcept;
  /// E g: what the unknowns y feel of ten slopes.
  [[nodiscard]] Ten share_of(const Ten& g) const noexcept;

 private:
  TenRows X_, E_;
  TenRows above_;         ///< columns of E at the pivots, above these and over them
  Dozen inverse_pivots_;  ///< 1 over the entries of E at the pivots
  std::array<int, 10> pivots_{};
  int shapes_ = 0;
  int rank_ = 0;
  int certain_ = 0;
  bool outdated_ = false;
  bool revealed_ = false;
};

}  // namespace shapeid::fast
