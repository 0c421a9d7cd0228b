// Householder reflections, a few at a time: what projection and compression spend their time on.
#pragma once

#include <Eigen/Core>

#include <array>

namespace shapeid::fast {

/// Up to four reflections 1 - x x^T / half, to be applied one after the other, with x = (top e, v):
/// each has one entry of its own, `top`, in a row above, and v in the rows that all of them share.
/// Applied together, a column is read and written once for all of them.
class Reflections {
 public:
  static constexpr int most = 4;

  /// `V`: the v's by columns, perhaps of length zero. It must stay where it is until applied.
  explicit Reflections(const Eigen::Ref<const Eigen::MatrixXd>& V) noexcept
      : v_(V.data()), stride_(V.outerStride()), rows_(V.rows()) {}

  /// Appends the reflection by the next column of V. An inverse of zero: it leaves all as it is.
  void append(double top, double inverse_half) noexcept;
  /// The same where there are no rows above.
  void append(double inverse_half) noexcept { append(0.0, inverse_half); }

  [[nodiscard]] int count() const noexcept { return count_; }

  /// To columns of the shared rows, with the rows of `above` in the order of the reflections.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns, Eigen::Ref<Eigen::MatrixXd> above) const noexcept;
  /// The same without rows above: every `top` is zero.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns) const noexcept;

 private:
  /// Columns `stride` apart.
  struct Columns {
    double* data;
    Eigen::Index stride;
  };
  void apply_to_all(Columns columns, Columns above, Eigen::Index count) const noexcept;
  template <int vectors>
  void apply_some(Columns columns, Columns above, Eigen::Index count) const noexcept;
  template <int vectors, int together>
  void apply_to(Columns columns, Columns above) const noexcept;

  const double* v_;
  Eigen::Index stride_, rows_;
  int count_ = 0;
  std::array<double, most> top_ = {}, inverse_half_ = {};
  std::array<std::array<double, most>, most> products_ = {};  ///< of v's with earlier ones
};

}  // namespace shapeid::fast
