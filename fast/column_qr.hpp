// QR decomposition of a set of columns that come and go, with the orthogonal factor kept as the
// product of reflections that made it.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

#include "shapeid/fast/row_reflection.hpp"
#include "shapeid/models/contract.hpp"

namespace shapeid::fast {

/// A P = Q T for the columns A that are in the set, and Q^T b, updated as columns enter and leave.
/// Q is never formed: it is a list of Householder reflections, each on consecutive rows. A column
/// that enters is reflected by all of them and adds one; a column that leaves adds one on two rows
/// for every column behind it. Backward stable in every step.
///
/// Nothing allocates or throws after construction.
class ColumnQr {
 public:
  /// Room for `most_columns` columns of `rows` rows.
  ColumnQr(Eigen::Index rows, Eigen::Index most_columns);

  /// No columns; the right-hand side is `b`, as many rows as said at construction.
  void start(const Eigen::Ref<const Eigen::VectorXd>& b) noexcept;

  /// The first `columns` remain, as if no others had come since start() or the last keep(); none
  /// may have been removed since then. `b` is that of start().
  void keep(Eigen::Index columns, const Eigen::Ref<const Eigen::VectorXd>& b) noexcept;
  [[nodiscard]] Violation why_not_kept(Eigen::Index columns) const;

  enum class Push {
    entered,
    dependent,  ///< nothing changed; dependence() tells of what
    crowded     ///< nothing changed; no room for columns or reflections: start again
  };

  /// Where the caller writes the column that enters next; or the one that enters `k` behind it.
  [[nodiscard]] auto entering(Eigen::Index k = 0) noexcept { return entering_.col(k).head(rows_); }
  /// Numbers from one such column to the next.
  [[nodiscard]] Eigen::Index stride() const noexcept { return entering_.rows(); }

  /// Adds entering() as the last column. Only its first `end` rows are read; the others count as
  /// zero. It is dependent if less than `smallest_share` of its length is new, or no more than
  /// 1e-150.
  Push push(Eigen::Index end) noexcept;
  static constexpr double smallest_share = 1e-13;
  /// The same for as many columns as `ends` has entries, up to most_columns of them, until one does
  /// not enter; returns how many did. Each reflection meets those behind it together, which takes
  /// less time than one after the other.
  Eigen::Index push_all(std::span<const Eigen::Index> ends) noexcept;

  /// After push() said so: coefficients x of the columns in the set with A x = the refused column,
  /// to rounding. Writes size() entries.
  void dependence(Eigen::VectorXd& x) const noexcept;

  /// Takes out the column at `place`; those behind it move forward. False if there is no room for
  /// the reflections: nothing changed.
  [[nodiscard]] bool remove(Eigen::Index place) noexcept;

  /// The x that minimises || A x - b ||. Writes size() entries.
  void solve(Eigen::VectorXd& x) const noexcept;

  /// Replaces x by the solution z of A^T A z = x, by T alone. First size() entries.
  void solve_normal(Eigen::VectorXd& x) const noexcept;

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] Eigen::Index most_columns() const noexcept { return T_.cols(); }

 private:
  [[nodiscard]] bool has_room(std::size_t reflections, std::size_t numbers) const noexcept;
  /// The column written at entering(k), of which the first `end` rows count.
  void begin(Eigen::Index k, Eigen::Index end) noexcept;
  /// What is written at entering(k), reflected by all that are there.
  [[nodiscard]] Push take_in(Eigen::Index k) noexcept;
  /// By these reflections: what is written at entering(k) and behind it, `count` columns.
  void reflect(const RowReflection* from, Eigen::Index k, Eigen::Index count) noexcept;
  void reflect_right_side() noexcept;
  /// Appends the reflection of rows [first, end) that maps `x` to a multiple of the first unit
  /// vector; returns the multiple.
  double append(const double* x, Eigen::Index first, Eigen::Index end, double length) noexcept;
  void back_substitute(Eigen::VectorXd& x) const noexcept;

  Eigen::Index rows_, size_ = 0;
  Eigen::MatrixXd T_;               ///< upper triangle of the first size_ columns
  Eigen::VectorXd rotated_;         ///< Q^T b; some zeros below
  Eigen::MatrixXd entering_;        ///< columns that enter; Q^T times them after push(); likewise
  std::vector<Eigen::Index> ends_;  ///< where their zeros begin
  std::vector<double> wholes_;      ///< their lengths
  std::vector<RowReflection> reflections_;
  std::vector<double> vectors_;  ///< of the reflections, one behind the other
  std::size_t used_ = 0;         ///< numbers in vectors_
};

}  // namespace shapeid::fast
